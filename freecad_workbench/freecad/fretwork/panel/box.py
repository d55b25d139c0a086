"""What the boxes of the task panel share."""

from __future__ import annotations

from ..qt import QtCore, QtWidgets


class Box(QtWidgets.QWidget):
    """A box of the panel, with its title, for one object."""

    changed = QtCore.Signal()  # a property was written

    def __init__(self, obj, name: str, title: str):
        super().__init__()
        self.setObjectName(name)
        self.setWindowTitle(title)
        self._obj = obj

    def close_box(self) -> None:
        """Called once, when the panel closes."""
