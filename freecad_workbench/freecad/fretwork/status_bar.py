"""Progress of a run in FreeCAD's status bar, with a button that stops it."""

from __future__ import annotations

import FreeCADGui as Gui

from .qt import QtCore, QtGui, QtWidgets
from .resources import icon
from .translation import translate


class JobBar(QtWidgets.QWidget):
    """The bar of one job; it goes away with it."""

    def __init__(self, label: str, job):
        status = Gui.getMainWindow().statusBar()
        super().__init__(status)
        self._label = label
        self._bar = QtWidgets.QProgressBar()
        self._bar.setRange(0, 1000)
        self._bar.setFixedWidth(260)
        stop = QtWidgets.QToolButton()
        stop.setIcon(QtGui.QIcon(icon("Stop")))
        stop.setToolTip(translate("Stop this run; the object stays as it was"))
        stop.clicked.connect(job.stop)
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._bar)
        layout.addWidget(stop)
        status.addPermanentWidget(self)
        job.progressed.connect(self.show_progress)
        for signal in (job.succeeded, job.failed):
            signal.connect(self._end)
        self.show_progress("", 0.0)

    @QtCore.Slot(str, float)
    def show_progress(self, stage: str, share: float) -> None:
        self._bar.setValue(round(1000 * share))
        self._bar.setFormat(f"{self._label}  {stage}  %p %")

    def _end(self, _value) -> None:
        self.parent().removeWidget(self)
        self.deleteLater()
