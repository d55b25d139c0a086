"""The program with what it says of itself."""

from __future__ import annotations

from functools import cached_property
from typing import Sequence

from .patterns import Pattern, parse_patterns
from .run import OnProgress, run
from .schema import Schema, parse_schema


class Engine:
    """A fretwork program. What it says of itself is asked once."""

    def __init__(self, program: str):
        self.program = program

    @cached_property
    def schema(self) -> Schema:
        """Every setting of a spec."""
        return parse_schema(self.run(["spec", "schema"]))

    @cached_property
    def patterns(self) -> list[Pattern]:
        """The built-in patterns."""
        return parse_patterns(self.run(["pattern", "list", "--json"]))

    @cached_property
    def version(self) -> str:
        return self.run(["--version"]).decode().split()[-1]

    def run(self, arguments: Sequence[str], on_progress: OnProgress | None = None) -> bytes:
        """Runs it to its end and gives its standard output. Raises EngineError."""
        return run(self.program, arguments, on_progress)
