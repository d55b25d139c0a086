"""Texts for the user, in the language that FreeCAD runs in."""

from __future__ import annotations

import FreeCAD as App


def noop(context: str, text: str) -> str:
    """Marks a text for the translators that FreeCAD itself will translate when it shows it."""
    return text


def translate(text: str) -> str:
    """A text of the workbench in the user's language."""
    return App.Qt.translate("Fretwork", text)
