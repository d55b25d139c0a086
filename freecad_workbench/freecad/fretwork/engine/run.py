"""Running the program: its progress, its messages, its result, and how it is stopped."""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass, field
from typing import Callable, Sequence

from .errors import error_of
from .program import clean_environment

OnProgress = Callable[[str, float], None]

DONE = 0
FALLS_SHORT = 4  # done, but strength or printability is not what was asked

_PREFIXES = ("fretwork: error: ", "fretwork: ")


@dataclass
class Messages:
    """Takes what the program writes to standard error, in pieces as they come: progress and words."""

    on_progress: OnProgress | None = None
    lines: list[str] = field(default_factory=list)
    _rest: bytes = b""

    def feed(self, data: bytes) -> None:
        """Takes the next bytes; lines count once they are complete."""
        *whole, self._rest = (self._rest + data).split(b"\n")
        for line in whole:
            self._take(line.decode("utf-8", "replace").strip())

    def finish(self) -> None:
        """Takes what came after the last end of a line."""
        self.feed(b"\n")

    def text(self) -> str:
        """The words, without progress."""
        return "\n".join(self.lines)

    def _take(self, line: str) -> None:
        if line.startswith('{"stage"'):
            step = json.loads(line)
            if self.on_progress:
                self.on_progress(step["stage"], step["fraction"])
        elif line:
            for prefix in _PREFIXES:
                line = line.removeprefix(prefix)
            self.lines.append(line)


def finished(exit_code: int, messages: Messages) -> None:
    """Raises what an exit code says unless the work is done."""
    if exit_code not in (DONE, FALLS_SHORT):
        raise error_of(130 if exit_code < 0 else exit_code, messages.text())


def run(program: str, arguments: Sequence[str], on_progress: OnProgress | None = None) -> bytes:
    """Runs the program to its end and gives its standard output.

    `on_progress` may raise, which stops the program and goes on to the caller.
    """
    messages = Messages(on_progress)
    # Standard error is read as it comes; output goes beside it, so that neither fills up.
    with subprocess.Popen(
        [program, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=clean_environment(),
    ) as process:
        try:
            output = _read_both(process, messages)
        except BaseException:
            process.terminate()
            raise
    finished(process.returncode, messages)
    return output


def _read_both(process: subprocess.Popen, messages: Messages) -> bytes:
    if messages.on_progress is None:
        output, errors = process.communicate()
        messages.feed(errors)
    else:
        # A run that reports progress writes its results into files and next to nothing to standard output.
        for line in process.stderr:
            messages.feed(line)
        output = process.stdout.read()
    messages.finish()
    return output
