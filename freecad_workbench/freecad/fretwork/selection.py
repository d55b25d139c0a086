"""What the user has selected, as the carve command takes it."""

from __future__ import annotations

from dataclasses import dataclass

import FreeCADGui as Gui

from .source import can_be_carved


@dataclass(frozen=True)
class Picked:
    """An object and faces of it; without any, all of it is meant."""

    source: object
    faces: tuple[str, ...]


def _source_of(obj):
    """Features of a body show what becomes of the body."""
    for parent in obj.InList:
        if parent.isDerivedFrom("PartDesign::Body") and obj in parent.Group:
            return parent
    return obj


def source_behind(obj, path: str):
    """The source that an element belongs to, where `path` leads from an object to it, as in "Body.Pad.Face3"."""
    inner = path.rsplit(".", 2)
    found = obj.Document.getObject(inner[-2]) if len(inner) > 1 else None
    return _source_of(found or obj)


def picked_source() -> Picked | None:
    """The first selected object that can be carved, with its selected faces."""
    for selected in Gui.Selection.getSelectionEx():
        source = _source_of(selected.Object)
        try:
            carvable = can_be_carved(source)
        except Exception:
            # A sketch, a datum or a document object without geometry: FreeCAD says so in many ways.
            carvable = False
        if carvable:
            faces = [name for name in selected.SubElementNames if name.startswith(("Face", "Segment"))]
            return Picked(source, tuple(faces))
    return None
