"""The task panel of a carved object."""

from __future__ import annotations

import FreeCADGui as Gui

from .. import background
from ..engine.errors import EngineError
from ..qt import QtCore, QtWidgets, number_of
from .faces_box import FacesBox
from .pattern_box import PatternBox
from .result_box import ResultBox
from .size_box import SizeBox

_DRAFT_AFTER_MS = 300


class CarvePanel:
    """Edits one object. What is changed while it is open is one step of undo; Cancel takes the step back."""

    def __init__(self, obj):
        self.obj = obj
        self._document = obj.Document
        self._result = ResultBox(obj, self.carve_in_full)
        self.form = [PatternBox(obj), FacesBox(obj), SizeBox(obj), self._result]
        self._later = QtCore.QTimer()
        self._later.setSingleShot(True)
        self._later.setInterval(_DRAFT_AFTER_MS)
        self._later.timeout.connect(self.draft)
        for box in self.form[:-1]:
            box.changed.connect(self._later.start)
        if not self._document.HasPendingTransaction:
            self._document.openTransaction(f"Edit {obj.Label}")

    def draft(self) -> None:
        """Brings the object up to date with its settings, as a recompute does."""
        self._later.stop()
        try:
            self.obj.Proxy.execute(self.obj)
        except EngineError as error:
            self._result.tell(str(error))

    def carve_in_full(self) -> None:
        self._later.stop()
        try:
            background.start(self.obj, self.obj.Proxy.request(self.obj), draft=False)
        except EngineError as error:
            self._result.tell(str(error))

    # --- FreeCAD calls these ---

    def getStandardButtons(self) -> int:
        box = QtWidgets.QDialogButtonBox
        return number_of(box.Ok | box.Cancel)

    def accept(self) -> bool:
        if self._later.isActive():
            self.draft()
        self._close_boxes()
        self._document.commitTransaction()
        self._end_editing()
        return True

    def reject(self) -> bool:
        background.stop(self.obj)
        self._close_boxes()
        # FreeCAD keeps what was done so far when editing ends.
        self._document.abortTransaction()
        self._end_editing()
        return True

    def _close_boxes(self) -> None:
        self._later.stop()
        for box in self.form:
            box.close_box()

    def _end_editing(self) -> None:
        Gui.getDocument(self._document.Name).resetEdit()
        # An object that is gone can no longer close its panel.
        Gui.Control.closeDialog()
