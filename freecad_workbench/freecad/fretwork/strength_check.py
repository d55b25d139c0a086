"""Check strength: the full analysis of a carved object, kept with the object that it is of."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path

from .engine.engine import Engine
from .engine.strength import strength_lines
from .mesh_files import read_face_colors
from .results import run_folder, run_to_end


@dataclass(frozen=True)
class Strength:
    """What the analysis found."""

    key: str  # of the request that the result was made for
    lines: list[str]
    colors: list[tuple[float, float, float]]  # one per triangle


class StrengthTask:
    """A run of `verify` on the 3MF of an object; see results.Task."""

    draft = False

    def __init__(self, package: Path, key: str):
        self.key = f"strength of {key}"
        self._of = key
        self.folder = run_folder()
        self._colored = self.folder / "stress.ply"
        self.steps = [["verify", str(package), "--json", "--stress", str(self._colored), "--progress", "json"]]

    def done(self, output: bytes) -> Strength:
        """Call once the run has ended well, with what it wrote."""
        colors = read_face_colors(self._colored) if self._colored.exists() else []
        self.discard()
        return Strength(self._of, strength_lines(json.loads(output)), colors)

    def discard(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)


def analyse(engine: Engine, package: Path, key: str) -> Strength:
    """The same, waiting for the end. Raises EngineError."""
    return run_to_end(engine, StrengthTask(package, key))
