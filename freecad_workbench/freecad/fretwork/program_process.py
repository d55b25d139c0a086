"""The program as a process beside FreeCAD's window."""

from __future__ import annotations

from typing import Sequence

from .engine.errors import Cancelled, EngineError, ProgramMissing
from .engine.program import clean_environment
from .engine.run import Messages, finished
from .qt import QtCore


class ProgramProcess(QtCore.QObject):
    """One run of the program."""

    progressed = QtCore.Signal(str, float)  # stage, share of the run
    succeeded = QtCore.Signal()
    failed = QtCore.Signal(object)  # EngineError; Cancelled after stop

    def __init__(self, program: str, arguments: Sequence[str], parent=None):
        super().__init__(parent)
        self._program = program
        self._arguments = list(arguments)
        self._stopped = False
        self._messages = Messages(self.progressed.emit)
        self._process = QtCore.QProcess(self)
        self._process.setProcessEnvironment(_environment())
        self._process.setStandardInputFile(QtCore.QProcess.nullDevice())
        self._process.readyReadStandardError.connect(self._read)
        self._process.finished.connect(self._finished)
        self._process.errorOccurred.connect(self._error)

    def start(self) -> None:
        self._process.start(self._program, self._arguments)

    def stop(self) -> None:
        """Ends the program, which leaves nothing behind."""
        self._stopped = True
        self._process.terminate()

    def output(self) -> bytes:
        """What it wrote to standard output."""
        return bytes(self._process.readAllStandardOutput())

    def _read(self) -> None:
        self._messages.feed(bytes(self._process.readAllStandardError()))

    def _error(self, error) -> None:
        # What has started tells how it ended by itself.
        if error == QtCore.QProcess.FailedToStart:
            why = self._process.errorString()
            self.failed.emit(ProgramMissing(f"{self._program} could not be started: {why}"))

    def _finished(self, exit_code: int, _status) -> None:
        self._read()
        self._messages.finish()
        try:
            if self._stopped:
                raise Cancelled("stopped")
            finished(exit_code, self._messages)
        except EngineError as error:
            self.failed.emit(error)
        else:
            self.succeeded.emit()


def _environment():
    environment = QtCore.QProcessEnvironment()
    for name, value in clean_environment().items():
        environment.insert(name, value)
    return environment
