"""Files that are read, not run: icons, forms, translations, help."""

from __future__ import annotations

from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def icon(name: str) -> str:
    """Path of an icon."""
    return str(FOLDER / "icons" / f"{name}.svg")
