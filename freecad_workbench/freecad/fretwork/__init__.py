"""Fretwork in FreeCAD: carve a pattern through the shell of a body, a shape or a mesh.

    import freecad.fretwork as fw
    carved = fw.carve(App.ActiveDocument.Body, pattern="cells", keep=["Face3"], shell_thickness_mm=2.4)

FreeCAD imports this when it starts, so nothing is loaded here that can wait.
"""

from __future__ import annotations

import importlib

try:
    import FreeCAD
except ImportError:
    # `freecad.fretwork.engine` is of use in any Python.
    FreeCAD = None

if FreeCAD:
    FreeCAD.__unit_test__ += [
        f"freecad.fretwork.tests.test_{subject}" for subject in ("engine", "settings", "carved", "window")
    ]
    FreeCAD.addExportType("3MF carved by Fretwork (*.3mf)", "freecad.fretwork.exchange")


# What scripts use. It lies in `api`, which is imported when one of these is first asked for.
_API = ("carve", "change", "check_strength", "export", "open_in_slicer", "patterns", "stop", "update")


def __getattr__(name: str):
    if name not in _API:
        raise AttributeError(f"module {__name__!r} has no {name!r}; it has {', '.join(_API)}")
    return getattr(importlib.import_module(".api", __name__), name)
