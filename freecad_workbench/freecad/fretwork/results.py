"""Results of runs: made, kept for the session, and put into objects."""

from __future__ import annotations

import atexit
import json
import shutil
import tempfile
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping

from .engine.engine import Engine
from .engine.errors import BadInput, BadSettings, CannotBeMet, EngineError
from .engine.request import CarveRequest, lay_down
from .engine.run import OnProgress


@dataclass(frozen=True)
class Result:
    """Files of a run that is done."""

    key: str  # of the request
    draft: bool
    mesh: Path
    package: Path | None  # 3MF; a draft has none
    report: Mapping[str, Any]


@dataclass
class Task:
    """A run that is to be made, in a folder of its own."""

    request: CarveRequest
    draft: bool
    folder: Path = field(default_factory=lambda: run_folder())

    def __post_init__(self):
        self.key = self.request.key()
        self._files = lay_down(self.request, self.folder)

    @property
    def steps(self) -> list[list[str]]:
        """Arguments of the program, run after run."""
        return self._files.draft_steps() if self.draft else self._files.full_steps()

    def done(self, _output: bytes) -> Result:
        """Call once all steps have ended well. The result is remembered."""
        report = json.loads(self._files.summary.read_text(encoding="utf-8"))
        package = None if self.draft else self._files.package
        result = Result(self.key, self.draft, self._files.mesh, package, report)
        _remember(result, self.folder)
        return result

    def discard(self) -> None:
        """Call where it did not come to an end."""
        shutil.rmtree(self.folder, ignore_errors=True)


class Share:
    """Progress of one of several steps as a share of all; the first takes nearly all of the time."""

    def __init__(self, step: int, steps: int, on_progress: OnProgress):
        first = 1.0 if steps == 1 else 0.95
        self._from = 0.0 if step == 0 else first
        self._width = first if step == 0 else 1.0 - first
        self._on_progress = on_progress

    def __call__(self, stage: str, fraction: float) -> None:
        self._on_progress(stage, self._from + self._width * fraction)


def make(engine: Engine, request: CarveRequest, draft: bool, on_progress: OnProgress | None = None) -> Result:
    """Runs the engine to its end, unless the same has been made before. Raises EngineError."""
    known = remembered(request.key(), draft)
    if known:
        return known
    return run_to_end(engine, Task(request, draft), on_progress)


def run_to_end(engine: Engine, task, on_progress: OnProgress | None = None):
    """Runs the steps of a task, waiting for them, and gives what it makes of them. Raises EngineError."""
    try:
        output = b""
        for number, arguments in enumerate(task.steps):
            output = engine.run(arguments, Share(number, len(task.steps), on_progress) if on_progress else None)
        return task.done(output)
    except BaseException:
        task.discard()
        raise


_MOST_REMEMBERED = 16
_remembered: OrderedDict[tuple[str, bool], tuple[Result, Path]] = OrderedDict()
_session: list[Path] = []


def run_folder() -> Path:
    """A folder for one run; those that are left go when FreeCAD ends."""
    return Path(tempfile.mkdtemp(prefix="run-", dir=_session_folder()))


def _session_folder() -> Path:
    if not _session:
        _session.append(Path(tempfile.mkdtemp(prefix="fretwork-")))
        atexit.register(shutil.rmtree, _session[0], ignore_errors=True)
    return _session[0]


def _remember(result: Result, folder: Path) -> None:
    _remembered[result.key, result.draft] = (result, folder)
    while len(_remembered) > _MOST_REMEMBERED:
        _, (_, oldest) = _remembered.popitem(last=False)
        shutil.rmtree(oldest, ignore_errors=True)


# Errors that the same request would meet again.
_LASTING = (BadSettings, BadInput, CannotBeMet)
_failed: OrderedDict[tuple[str, bool], EngineError] = OrderedDict()


def remember_failure(key: str, draft: bool, error: EngineError) -> None:
    """So that nobody tries again what cannot be; a program that is missing or was stopped is no such failure."""
    if isinstance(error, _LASTING):
        _failed[key, draft] = error
        while len(_failed) > _MOST_REMEMBERED:
            _failed.popitem(last=False)


def failure(key: str, draft: bool) -> EngineError | None:
    """Why the same request failed earlier in this session."""
    return _failed.get((key, draft))


def remembered(key: str, draft: bool) -> Result | None:
    """A result of this session: engine and request being the same, so would be another run's."""
    found = _remembered.get((key, draft))
    if not found:
        return None
    _remembered.move_to_end((key, draft))
    return found[0]
