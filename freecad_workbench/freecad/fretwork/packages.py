"""The 3MF of a carved object: to a file, and on to a slicer."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Iterable, Sequence

import FreeCAD as App

from .carved import is_carved
from .engine.errors import BadInput, BadSettings, EngineError
from .engine.program import clean_environment
from .engine.request import file_name
from .engine.slicers import Slicer, choose_slicer, find_slicers
from .preferences import parameters

_KEPT_FOR_SLICER_S = 24 * 3600


def package_of(obj) -> Path:
    """The 3MF of the present settings. Raises BadInput for what is no carved object, BadSettings where only a draft
    or an older result is there."""
    if not is_carved(obj):
        raise BadInput(f"{obj.Label}: found {obj.TypeId}, expected an object that Fretwork has carved")
    if not obj.Package or obj.PackageKey != obj.Proxy.request(obj).key():
        raise BadSettings(f"{obj.Label}: found {'an older result' if obj.Package else 'no full result'}, "
                          "expected one of the present settings: carve it in full first")  # fmt: skip
    return Path(obj.Package)


def _names(objects: Sequence) -> list[str]:
    """Names of files, each another: FreeCAD lets objects have the same label."""
    names: list[str] = []
    for obj in objects:
        name = file_name(obj.Label)
        names.append(name if name not in names else f"{name}-{obj.Name}")
    return names


def _copy_all(pairs: Iterable[tuple[Path, Path]]) -> None:
    """Copies files; each target is whole or as it was, and none is touched before all have room."""
    written: list[tuple[str, Path]] = []
    try:
        for source, target in pairs:
            handle, path = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
            written.append((path, target))
            with open(source, "rb") as whole, open(handle, "wb") as copy:
                shutil.copyfileobj(whole, copy)
                copy.flush()
                os.fsync(copy.fileno())
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(path, 0o666 & ~mask)
        while written:
            os.replace(*written[0])
            del written[0]
    except OSError as error:
        raise BadInput(f"{target}: cannot be written: {error.strerror}") from error
    finally:
        for path, _ in written:
            os.unlink(path)


def export(objects: Sequence, path: str) -> list[str]:
    """Writes the 3MF of a carved object; of several each into a file of its own, with its label behind the name.

    Gives the paths. Nothing is written unless all can be. Raises EngineError.
    """
    packages = [package_of(obj) for obj in objects]
    target = Path(path)
    targets = [target]
    if len(packages) > 1:
        targets = [target.with_name(f"{target.stem}-{name}{target.suffix}") for name in _names(objects)]
    _copy_all(zip(packages, targets))
    return [str(to) for to in targets]


def _slicer_folder() -> Path:
    """A new folder for what a slicer opens. It outlives the session, as the slicer may; those of yesterday go."""
    parent = Path(App.getUserCachePath()) / "Fretwork" / "slicer"
    parent.mkdir(parents=True, exist_ok=True)
    for old in parent.iterdir():
        if time.time() - old.stat().st_mtime > _KEPT_FOR_SLICER_S:
            shutil.rmtree(old, ignore_errors=True)
    return Path(tempfile.mkdtemp(dir=parent))


def open_in_slicer(objects: Sequence, slicer: str = "") -> Slicer:
    """Opens the 3MF of carved objects in a slicer, beside FreeCAD: the one that is named, that of the preferences, or
    the first that is installed. Raises EngineError."""
    try:
        chosen = choose_slicer(slicer or parameters().GetString("Slicer", ""), find_slicers())
    except LookupError as error:
        raise EngineError(str(error)) from error
    packages = [package_of(obj) for obj in objects]
    folder = _slicer_folder()
    # The slicer shows the name of the file.
    paths = [folder / f"{name}.3mf" for name in _names(objects)]
    _copy_all(zip(packages, paths))
    subprocess.Popen([*chosen.command, *map(str, paths)], env=clean_environment(), start_new_session=True,
                     stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
    return chosen
