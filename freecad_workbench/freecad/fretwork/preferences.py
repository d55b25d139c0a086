"""What the user has chosen for all documents, and the engine that follows from it."""

from __future__ import annotations

from functools import lru_cache

import FreeCAD as App

from .engine.engine import Engine
from .engine.program import find_program

GROUP = "User parameter:BaseApp/Preferences/Mod/Fretwork"


def parameters():
    """FreeCAD's store of the workbench's preferences."""
    return App.ParamGet(GROUP)


@lru_cache(maxsize=4)
def _engine_at(program: str) -> Engine:
    return Engine(program)


def engine() -> Engine:
    """The engine in use. Raises ProgramMissing."""
    return _engine_at(find_program(parameters().GetString("Program", "")))
