"""Slicers on this machine."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Iterable, Mapping


@dataclass(frozen=True)
class Slicer:
    """A slicer that takes a 3MF as the last argument."""

    name: str
    command: tuple[str, ...]


# Name, programs on the PATH, and the name as a Flatpak.
_KNOWN = (
    ("PrusaSlicer", ("prusa-slicer", "PrusaSlicer", "prusa-gui-slicer"), "com.prusa3d.PrusaSlicer"),
    ("OrcaSlicer", ("orca-slicer", "OrcaSlicer"), "com.orcaslicer.OrcaSlicer"),
    ("Bambu Studio", ("bambu-studio", "BambuStudio"), "com.bambulab.BambuStudio"),
    ("Cura", ("cura", "UltiMaker-Cura", "Ultimaker-Cura"), "com.ultimaker.cura"),
)

_FLATPAKS = (Path("/var/lib/flatpak/exports/bin"), Path.home() / ".local/share/flatpak/exports/bin")


def find_slicers(environment: Mapping[str, str] = os.environ, flatpaks: Iterable[Path] = _FLATPAKS) -> list[Slicer]:
    """Those that are installed, one of each kind."""
    found = []
    for name, programs, flatpak in _KNOWN:
        paths = [shutil.which(program, path=environment.get("PATH")) for program in programs]
        paths += [str(folder / flatpak) for folder in flatpaks if os.access(folder / flatpak, os.X_OK)]
        path = next(filter(None, paths), None)
        if path:
            found.append(Slicer(name, (path,)))
    return found


def choose_slicer(asked: str, found: list[Slicer]) -> Slicer:
    """The one that is asked for, by name or as a path of a program; empty: the first. Raises LookupError."""
    for slicer in found:
        if not asked or slicer.name.casefold() == asked.casefold():
            return slicer
    if asked and os.access(asked, os.X_OK) and os.path.isfile(asked):
        return Slicer(Path(asked).name, (asked,))
    there = ", ".join(slicer.name for slicer in found) or "none"
    wanted = f"{asked!r}" if asked else "PrusaSlicer, OrcaSlicer, Bambu Studio or Cura"
    raise LookupError(f"found no slicer {wanted}; there is {there}; name a program in Edit > Preferences > Fretwork")
