"""The 3MF of a carved object: to a file, and on to a slicer."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import Sequence

from .carved import is_carved
from .engine.errors import BadInput, BadSettings, EngineError
from .engine.program import clean_environment
from .engine.slicers import Slicer, choose_slicer, find_slicers
from .preferences import parameters


def package_of(obj) -> Path:
    """The 3MF of the present settings. Raises BadInput for what is no carved object, BadSettings where only a draft
    or an older result is there."""
    if not is_carved(obj):
        raise BadInput(f"{obj.Label}: found {obj.TypeId}, expected an object that Fretwork has carved")
    if not obj.Package or obj.PackageKey != obj.Proxy.request(obj).key():
        raise BadSettings(f"{obj.Label}: found {'an older result' if obj.Package else 'no full result'}, "
                          "expected one of the present settings: carve it in full first")  # fmt: skip
    return Path(obj.Package)


def export(objects: Sequence, path: str) -> list[str]:
    """Writes the 3MF of a carved object; of several each into a file of its own, with its label behind the name.

    Gives the paths. Nothing is written unless all can be. Raises EngineError.
    """
    packages = [package_of(obj) for obj in objects]
    target = Path(path)
    if len(packages) == 1:
        targets = [target]
    else:
        targets = [target.with_name(f"{target.stem}-{obj.Label.replace('/', '_')}{target.suffix}") for obj in objects]
    try:
        for package, to in zip(packages, targets):
            shutil.copyfile(package, to)
    except OSError as error:
        raise BadInput(f"{error.filename}: cannot be written: {error.strerror}") from error
    return [str(to) for to in targets]


def open_in_slicer(objects: Sequence, slicer: str = "") -> Slicer:
    """Opens the 3MF of carved objects in a slicer, beside FreeCAD: the one that is named, that of the preferences, or
    the first that is installed. Raises EngineError."""
    import subprocess

    try:
        chosen = choose_slicer(slicer or parameters().GetString("Slicer", ""), find_slicers())
    except LookupError as error:
        raise EngineError(str(error)) from error
    # The slicer may outlive the session, and shows the name of the file.
    folder = Path(tempfile.mkdtemp(prefix="fretwork-"))
    paths = []
    for obj in objects:
        paths += export([obj], str(folder / f"{obj.Label.replace('/', '_')}.3mf"))
    subprocess.Popen([*chosen.command, *paths], env=clean_environment(), start_new_session=True,
                     stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
    return chosen
