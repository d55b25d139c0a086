"""Everything the workbench does, for scripts and macros: `import freecad.fretwork as fw`."""

from __future__ import annotations

import difflib
from typing import Any, Iterable

import FreeCAD as App

from .carved import Carved, properties_of_settings
from .engine.errors import BadSettings
from .packages import export, open_in_slicer, package_of
from .preferences import engine
from .results import make, remembered
from .setting_properties import PATTERN, PICTURES, SettingProperty
from .strength_check import analyse

__all__ = ["carve", "change", "check_strength", "export", "open_in_slicer", "patterns", "stop", "update"]


def carve(
    source,
    pattern: str | None = None,
    faces: Iterable[str] = (),
    keep: Iterable[str] = (),
    image: str | None = None,
    draft: bool = False,
    wait: bool = True,
    name: str = "Carved",
    **settings: Any,
):
    """Carves an object of a document and gives the new object.

    source    a body, shape or mesh
    pattern   one of `patterns()`, or `image` for a picture of your own
    faces     carve these alone, as in ["Face3", "Face7"]; none: the whole surface
    keep      faces that stay solid
    draft     make a draft of some seconds instead of the whole result
    wait      return when it is done; else it is made beside FreeCAD's window
    settings  any key of a spec, as in shell_thickness_mm=2.4 or synthesis_seed=7
    """
    document = source.Document
    obj = document.addObject("Mesh::FeaturePython", name)
    Carved(obj)
    if App.GuiUp:
        # There are views with a window only.
        from .carved_view import CarvedView

        CarvedView(obj.ViewObject)
        source.ViewObject.Visibility = False
    _put_beside(obj, source)
    obj.Source = source
    obj.Placement = source.Placement
    obj.CarveFaces = [(source, tuple(faces))] if faces else []
    obj.KeepFaces = [(source, tuple(keep))] if keep else []
    obj.Label = f"{source.Label} carved"
    try:
        change(obj, pattern=pattern, image=image, **settings)
        update(obj, draft, wait)
    except BaseException:
        document.removeObject(obj.Name)
        raise
    return obj


def change(obj, pattern: str | None = None, image: str | None = None, **settings: Any) -> None:
    """Changes settings of a carved object, by the keys of a spec with `_` for the dot. Nothing is carved."""
    given = {_key_of(word): value for word, value in settings.items()}
    if pattern is not None:
        given[PATTERN] = pattern
    if image is not None:
        given[PICTURES[0]] = image
        given[PATTERN] = None
    properties = {entry.setting.key: entry for entry in properties_of_settings()}
    for key, value in given.items():
        _write(obj, properties[key], value)


def update(obj, draft: bool = False, wait: bool = True) -> None:
    """Carves an object with its present settings: in full, or as a draft.

    Returns when it is done, or with wait=False at once where there is a window.
    """
    request = obj.Proxy.request(obj)
    known = remembered(request.key(), draft)
    if known or not App.GuiUp:
        obj.Proxy.show(obj, known or make(engine(), request, draft))
        obj.purgeTouched()
        return
    # Qt is there with a window only.
    from . import background

    job = background.start(obj, request, draft)
    if wait:
        job.wait()


def check_strength(obj, wait: bool = True) -> None:
    """Analyses the full result of an object voxel by voxel, as `fretwork verify` does, and shows its stress.

    What it finds is in the properties Strength and ShowStress. With wait=False it goes on beside the window.
    """
    package, key = package_of(obj), obj.PackageKey
    if not App.GuiUp:
        obj.Proxy.show_strength(obj, analyse(engine(), package, key))
        obj.purgeTouched()
        return
    from . import background

    job = background.start_check(obj, package, key)
    if wait:
        job.wait()


def stop(obj) -> None:
    """Ends the run of an object, if one goes on; the object stays as it was."""
    if App.GuiUp:
        from . import background

        background.stop(obj)


def patterns() -> list[str]:
    """Names of the patterns that come with the engine."""
    return [pattern.name for pattern in engine().patterns]


def _write(obj, entry: SettingProperty, value: Any) -> None:
    if entry.choices and value is not None and isinstance(value, str) and value not in entry.choices:
        raise BadSettings(f"{entry.setting.key} = {value!r}: expected one of {', '.join(entry.choices)}")
    if entry.setting.key in PICTURES:
        setattr(obj, entry.name, value or "")
    else:
        entry.write(obj, value)


def _key_of(word: str) -> str:
    """`shell_thickness_mm` is shell.thickness_mm."""
    known = {entry.setting.key for entry in properties_of_settings()}
    key = word if word in known else word.replace("_", ".", 1)
    if key not in known:
        near = difflib.get_close_matches(key, known, 1)
        raise BadSettings(f"there is no setting {key!r}" + (f"; did you mean {near[0]!r}?" if near else ""))
    return key


def _put_beside(obj, source) -> None:
    """An object belongs where its source is: in the same part, or group."""
    for parent in source.InList:
        if parent.hasExtension("App::GroupExtension") and source in parent.Group:
            if not parent.isDerivedFrom("PartDesign::Body"):
                parent.addObject(obj)
                return
