"""Qt as this FreeCAD has it: PySide2 with Qt 5, or PySide6 with Qt 6."""

from __future__ import annotations

from PySide import QtCore, QtGui

try:
    from PySide import QtWidgets
except ImportError:
    # FreeCAD up to 0.20 has the widgets among QtGui.
    QtWidgets = QtGui

__all__ = ["QtCore", "QtGui", "QtWidgets", "number_of", "run"]


def run(loop) -> int:
    """Runs an event loop or a dialog."""
    return (getattr(loop, "exec", None) or loop.exec_)()


def number_of(flags) -> int:
    """Flags as the number that FreeCAD takes."""
    return flags.value if hasattr(flags, "value") else int(flags)
