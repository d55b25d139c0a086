"""What is made: drafts while settings change, the whole result by request, and what came of it in words."""

from __future__ import annotations

import html

from .. import background
from ..carved import BY_REQUEST, DRAFT_AUTOMATICALLY
from ..engine.errors import Cancelled
from ..qt import QtCore, QtGui, QtWidgets
from ..resources import icon
from ..translation import translate
from .box import Box


def same_object(one, other) -> bool:
    """Whether both stand for the same object of a document; one that is deleted stands for none."""
    try:
        return (one.Document.Name, one.Name) == (other.Document.Name, other.Name)
    except ReferenceError:
        return False


class ResultBox(Box):
    """Starts, shows and stops the runs of the object."""

    def __init__(self, obj, carve_in_full):
        super().__init__(obj, "FretworkResult", translate("Result"))
        self._live = QtWidgets.QCheckBox(translate("Show a draft of every change"))
        self._live.setChecked(obj.Update == DRAFT_AUTOMATICALLY)
        self._live.toggled.connect(self._set_live)
        self.run = QtWidgets.QPushButton(QtGui.QIcon(icon("Update")), translate("Carve in full"))
        self.run.setObjectName("FretworkRun")
        self.run.clicked.connect(carve_in_full)
        self.stop = QtWidgets.QPushButton(QtGui.QIcon(icon("Stop")), translate("Stop"))
        self.stop.setObjectName("FretworkStop")
        self.stop.clicked.connect(lambda: background.stop(obj))
        self._bar = QtWidgets.QProgressBar()
        self._bar.setRange(0, 1000)
        self.text = QtWidgets.QLabel()
        self.text.setObjectName("FretworkSummary")
        self.text.setWordWrap(True)
        self.text.setTextFormat(QtCore.Qt.RichText)
        buttons = QtWidgets.QHBoxLayout()
        buttons.addWidget(self.run)
        buttons.addWidget(self.stop)
        layout = QtWidgets.QVBoxLayout(self)
        layout.addWidget(self._live)
        layout.addLayout(buttons)
        layout.addWidget(self._bar)
        layout.addWidget(self.text)
        self._closed = False
        background.listeners.append(self._watch)
        job = background.job_of(obj)
        if job:
            self._watch(obj, job)
        else:
            self._show()

    def close_box(self) -> None:
        self._closed = True
        background.listeners.remove(self._watch)

    def tell(self, words: str) -> None:
        """Says why nothing is made."""
        self._show(words)

    def _set_live(self, live: bool) -> None:
        self._obj.Update = DRAFT_AUTOMATICALLY if live else BY_REQUEST

    def _watch(self, obj, job) -> bool:
        if self._closed or not same_object(obj, self._obj):
            return False
        job.progressed.connect(self._progress)
        # The object takes its result first.
        job.succeeded.connect(lambda _: QtCore.QTimer.singleShot(0, self._show))
        job.failed.connect(lambda error: QtCore.QTimer.singleShot(0, lambda: self._failed(error)))
        self._busy(True)
        self._bar.setFormat(translate("Draft") if job.task.draft else translate("Full run"))
        return True

    def _progress(self, stage: str, share: float) -> None:
        if self._closed:
            return
        self._bar.setValue(round(1000 * share))
        self._bar.setFormat(f"{stage} %p %")

    def _failed(self, error) -> None:
        self._show("" if isinstance(error, Cancelled) else str(error))

    def _busy(self, busy: bool) -> None:
        self.stop.setEnabled(busy)
        self._bar.setVisible(busy)

    def _show(self, problem: str = "") -> None:
        """What the object says of itself."""
        if self._closed or not same_object(self._obj, self._obj) or background.job_of(self._obj):
            return
        self._busy(False)
        facts = [*self._obj.Summary, *self._obj.Strength]
        lines = [f"<b>{html.escape(translate(self._obj.State))}</b>", *map(html.escape, facts)]
        words = [problem] if problem else self._obj.Warnings
        lines += [f"<span style='color:#b35900'>&#9888; {html.escape(word)}</span>" for word in words]
        self.text.setText("<br>".join(lines))
