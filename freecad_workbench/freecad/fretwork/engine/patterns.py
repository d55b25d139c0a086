"""The patterns that come with the program."""

from __future__ import annotations

import json
from dataclasses import dataclass


@dataclass(frozen=True)
class Pattern:
    """A built-in pattern."""

    name: str
    description: str
    directed: bool  # has an up
    width_mm: float


def parse_patterns(text: str | bytes) -> list[Pattern]:
    """Reads what `fretwork pattern list --json` prints."""
    return [Pattern(p["name"], p["description"], p["directed"], p["width_mm"]) for p in json.loads(text)]
