"""Runs beside FreeCAD: the window stays alive, a newer request of an object replaces an older one, stopping is at once.

The engine runs as a program of its own, so that nothing it does can take FreeCAD down.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Callable

import FreeCAD as App

from .engine.errors import Cancelled, EngineError
from .engine.request import CarveRequest
from .preferences import engine
from .program_process import ProgramProcess
from .qt import QtCore, run
from .results import Result, Share, Task, remember_failure
from .status_bar import JobBar
from .strength_check import Strength, StrengthTask


class Job(QtCore.QObject):
    """One task, run by the program step after step."""

    progressed = QtCore.Signal(str, float)  # stage, share of the whole
    succeeded = QtCore.Signal(object)  # what the task has made
    failed = QtCore.Signal(object)  # EngineError

    def __init__(self, program: str, task: Task | StrengthTask, parent=None):
        super().__init__(parent)
        self.task = task
        self._program = program
        self._step = 0

    def start(self) -> None:
        steps = self.task.steps
        self._process = ProgramProcess(self._program, steps[self._step], self)
        share = Share(self._step, len(steps), self.progressed.emit)
        self._process.progressed.connect(lambda stage, fraction: share(stage, fraction))
        self._process.succeeded.connect(self._step_done)
        self._process.failed.connect(self._fail)
        self._process.start()

    def stop(self) -> None:
        """Ends it. `failed` follows with Cancelled."""
        self._process.stop()

    def wait(self) -> Result:
        """Lets the window live until the end, and gives the result. Raises EngineError."""
        loop = QtCore.QEventLoop()
        ended: list = []
        for signal in (self.succeeded, self.failed):
            signal.connect(lambda value: (ended.append(value), loop.quit()))
        run(loop)
        if isinstance(ended[0], EngineError):
            raise ended[0]
        return ended[0]

    def _step_done(self) -> None:
        self._step += 1
        if self._step < len(self.task.steps):
            self.start()
        else:
            self.succeeded.emit(self.task.done(self._process.output()))

    def _fail(self, error: EngineError) -> None:
        self.task.discard()
        remember_failure(self.task.key, self.task.draft, error)
        self.failed.emit(error)


class _Running:
    """The job of one object, and whom it tells."""

    def __init__(self, obj, job: Job):
        self.document, self.name, self.job = obj.Document.Name, obj.Name, job

    def object(self):
        """The object, unless it or its document is gone by now."""
        document = App.listDocuments().get(self.document)
        return document.getObject(self.name) if document else None


_running: dict[tuple[str, str], _Running] = {}

# Each is called as `listener(obj, job)` when a job begins; who shows its progress answers True.
listeners: list[Callable[..., bool]] = []


class _Documents:
    """What happens to documents while runs go on; FreeCAD calls it by the names of the functions."""

    def slotDeletedDocument(self, document) -> None:
        for running in list(_running.values()):
            if running.document == document.Name:
                running.job.stop()

    def slotUndoDocument(self, document) -> None:
        # A result that came after its step was closed is no part of the step.
        name = document.Name
        QtCore.QTimer.singleShot(0, lambda: _refresh(name))

    slotRedoDocument = slotUndoDocument


def _refresh(name: str) -> None:
    document = App.listDocuments().get(name)
    for obj in document.Objects if document else ():
        refresh = getattr(getattr(obj, "Proxy", None), "refresh", None)
        if refresh:
            refresh(obj)
            obj.purgeTouched()


@lru_cache(maxsize=1)
def watch_documents() -> _Documents:
    """Begins to; once is enough."""
    observer = _Documents()
    App.addDocumentObserver(observer)
    return observer


def jobs() -> list[Job]:
    """All that run."""
    return [running.job for running in _running.values()]


def job_of(obj) -> Job | None:
    """The job that runs for an object."""
    running = _running.get((obj.Document.Name, obj.Name))
    return running.job if running else None


def stop(obj) -> None:
    """Ends the job of an object, if there is one."""
    job = job_of(obj)
    if job:
        job.stop()


def start(obj, request: CarveRequest, draft: bool) -> Job:
    """Starts a run whose result goes into the object. One for the same request goes on; any other is replaced."""
    before = job_of(obj)
    if before:
        if (before.task.key, before.task.draft) == (request.key(), draft):
            return before
    return _begin(obj, Task(request, draft), _show, _tell)


def start_check(obj, package: Path, key: str) -> Job:
    """Starts the full analysis of what an object shows; a run of the object is ended first."""
    return _begin(obj, StrengthTask(package, key), _show_strength, _tell_check)


def _begin(obj, task: Task | StrengthTask, show: Callable, tell: Callable) -> Job:
    stop(obj)
    job = Job(engine().program, task)
    watch_documents()
    running = _Running(obj, job)
    where = (running.document, running.name)
    _running[where] = running

    def ended(apply: Callable, value) -> None:
        if _running.get(where) is running:
            del _running[where]
            target = running.object()
            if target:
                apply(target, value)
        job.deleteLater()

    job.succeeded.connect(lambda result: ended(show, result))
    job.failed.connect(lambda error: ended(tell, error))
    job.start()
    if not any([listener(obj, job) for listener in listeners]):
        JobBar(obj.Label, job)
    return job


def _show(obj, result: Result) -> None:
    obj.Proxy.show(obj, result)
    obj.purgeTouched()


def _show_strength(obj, strength: Strength) -> None:
    obj.Proxy.show_strength(obj, strength)
    obj.purgeTouched()


def _tell_check(obj, error: EngineError) -> None:
    if not isinstance(error, Cancelled):
        obj.Strength = [str(error)]
        App.Console.PrintError(f"{obj.Label}: {error}\n")
    obj.purgeTouched()


def _tell(obj, error: EngineError) -> None:
    if not isinstance(error, Cancelled):
        obj.Proxy.show_failure(obj, error)
        App.Console.PrintError(f"{obj.Label}: {error}\n")
    obj.purgeTouched()
