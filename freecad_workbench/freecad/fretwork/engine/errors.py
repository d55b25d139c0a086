"""What can go wrong with a run of the program, by cause."""

from __future__ import annotations


class EngineError(Exception):
    """The program could not do what was asked; the text says what was found and what was expected."""


class ProgramMissing(EngineError):
    """There is no fretwork program, or what was named is none."""


class BadSettings(EngineError):
    """A setting or a name in the spec is not known or out of range."""


class BadInput(EngineError):
    """A model or picture cannot be read, or a result cannot be written."""


class CannotBeMet(EngineError):
    """The settings contradict each other; the text names a value that would work."""


class Cancelled(EngineError):
    """The run was stopped before its end."""


_CAUSES = {1: BadSettings, 2: BadInput, 3: CannotBeMet, 130: Cancelled}


def error_of(exit_code: int, text: str) -> EngineError:
    """The error that an exit code other than 0 and 4 stands for (docs/cli.md)."""
    cause = _CAUSES.get(exit_code, EngineError)
    return cause(text or f"the fretwork program ended with code {exit_code} and said nothing")
