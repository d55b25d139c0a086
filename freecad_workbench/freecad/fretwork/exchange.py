"""File > Export: carved objects as the 3MF that the engine wrote. FreeCAD calls `export`."""

from __future__ import annotations

import FreeCAD as App

from . import packages


def export(objects, path: str) -> None:
    """Writes the selected carved objects."""
    for written in packages.export(objects, path):
        App.Console.PrintMessage(f"{written}\n")
