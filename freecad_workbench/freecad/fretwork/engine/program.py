"""Where the fretwork program is, and the surroundings it is started in."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import Mapping

from .errors import ProgramMissing

_NAME = "fretwork.exe" if sys.platform == "win32" else "fretwork"
_ADDON = Path(__file__).resolve().parents[3]


def _runs(path: str | os.PathLike) -> bool:
    return os.path.isfile(path) and os.access(path, os.X_OK)


def find_program(preferred: str = "", environment: Mapping[str, str] = os.environ) -> str:
    """Path of the program: `preferred`, $FRETWORK, the addon's own bin folder, or on the PATH, in this order.

    Whoever names a program gets that one or an error, not another.
    """
    for named, by in ((preferred, "the preferences"), (environment.get("FRETWORK", ""), "the variable FRETWORK")):
        if named:
            if _runs(named):
                return named
            raise ProgramMissing(f"{by} name {named!r} as the fretwork program, and there is no such program")
    own = _ADDON / "bin" / _NAME
    found = str(own) if _runs(own) else shutil.which(_NAME, path=environment.get("PATH"))
    if found:
        return found
    raise ProgramMissing(
        "the fretwork program was not found: install the package fretwork, or name the program in "
        "Edit > Preferences > Fretwork or in the environment variable FRETWORK"
    )


def clean_environment(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment for the program. An AppImage or Snap of FreeCAD puts its own libraries first, which are not
    those that the program was built with."""
    kept = dict(environment)
    if "APPIMAGE" in kept or "SNAP" in kept:
        for name in ("LD_LIBRARY_PATH", "PYTHONHOME", "PYTHONPATH", "QT_PLUGIN_PATH"):
            kept.pop(name, None)
    return kept
