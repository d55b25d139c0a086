"""The object that is carved: its geometry for the engine, and its faces by the engine's names.

Geometry is handed over in the object's own coordinates, so that moving an object does not change what is carved.
A shape goes as BREP, exact and with FreeCAD's numbers of faces, which the engine's reader keeps; a mesh goes as PLY.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from dataclasses import dataclass
from typing import Any, Iterable, Sequence

import FreeCAD as App
import Part

from .engine.errors import BadInput
from .engine.spec import Region


@dataclass(frozen=True)
class Model:
    """Geometry for the engine."""

    data: bytes
    format: str  # extension of a file
    fingerprint: str  # equal for equal geometry, also when it has been saved and read again


def linked(obj):
    """What an App::Link stands for, or the object itself."""
    return obj.getLinkedObject(True) or obj


def is_mesh(obj) -> bool:
    """Whether its geometry is a mesh rather than a shape."""
    return linked(obj).isDerivedFrom("Mesh::Feature")


def can_be_carved(obj) -> bool:
    """Whether it has a surface: a mesh with triangles, or a shape with faces."""
    return linked(obj).Mesh.CountFacets > 0 if is_mesh(obj) else len(local_shape(obj).Faces) > 0


def same_placement(one, other) -> bool:
    """Whether two placements differ by no more than what computing them leaves."""
    return (one.Base - other.Base).Length < 1e-9 and one.Rotation.isSame(other.Rotation, 1e-12)


def local_shape(obj):
    """The shape without the placement of the object."""
    shape = Part.Shape(Part.getShape(obj))
    shape.Placement = App.Placement()
    return shape


def _shape_model(shape) -> Model:
    # A copy without the triangles that FreeCAD keeps for its view: they would become the engine's.
    text = shape.copy(True, False).exportBrepToString()
    return Model(text.encode(), "brep", _fingerprint(text))


def _fingerprint(brep: str) -> str:
    """Saving and reading change the last digits of numbers, and marks of what has been checked."""
    digest = hashlib.sha256()
    for word in brep.split():
        if len(word) == 7 and not word.strip("01"):
            continue
        try:
            word = f"{round(float(word), 6) + 0.0:.6f}"
        except ValueError:
            pass
        digest.update(word.encode() + b" ")
    return digest.hexdigest()


def _mesh_model(mesh) -> Model:
    data = _ply(mesh)
    return Model(data, "ply", hashlib.sha256(data).hexdigest())


def _ply(mesh) -> bytes:
    mesh = mesh.copy()
    mesh.Placement = App.Placement()
    folder = tempfile.mkdtemp(prefix="fretwork-")
    path = os.path.join(folder, "mesh.ply")
    try:
        mesh.write(path)
        with open(path, "rb") as file:
            return file.read()
    finally:
        os.remove(path)
        os.rmdir(folder)


def model_of(obj) -> Model:
    """The geometry of an object. Raises BadInput where it has none."""
    if not can_be_carved(obj):
        raise BadInput(f"{obj.Label}: found no face, expected a body, a shape or a mesh with at least one")
    return _mesh_model(linked(obj).Mesh) if is_mesh(obj) else _shape_model(local_shape(obj))


def _stands_for(picked, source) -> bool:
    """Whether faces picked on one object are those of the source: a body shows the shape of its tip."""
    return picked in (source, linked(source)) or picked == getattr(linked(source), "Tip", None)


def element_names(links: Iterable[tuple[Any, Sequence[str]]], source) -> list[str]:
    """Names of faces (of a mesh: segments) without what leads to them. Raises BadInput where they are of another
    object than the source."""
    names = []
    for picked, paths in links:
        for path in paths:
            name = path.rsplit(".", 1)[-1]
            if not _stands_for(picked, source):
                raise BadInput(f"{name or 'all'} of {picked.Label}: found on another object, "
                               f"expected on {source.Label}")  # fmt: skip
            names.append(name)
    return names


def _number(name: str, kind: str, source) -> int:
    digits = name.removeprefix(kind)
    if not name.startswith(kind) or not digits.isdecimal():
        raise BadInput(f"{source.Label}: found {name or 'the whole object'}, "
                       f"expected a {kind.lower()} such as {kind}3")  # fmt: skip
    return int(digits)


def region_of(table: str, links: Iterable[tuple[Any, Sequence[str]]], source, name: str = "", **more: Any) -> Region:
    """The region that picked faces make. Raises BadInput for what is no face or is not there."""
    names = element_names(links, source)
    if is_mesh(source):
        mesh = linked(source).Mesh
        numbers = [_number(element, "Segment", source) for element in names]
        _check(numbers, mesh.countSegments(), "Segment", source)
        triangles = {t for number in numbers for t in mesh.getSegment(number - 1)}
        return Region.of_triangles(table, triangles, name, **more)
    numbers = [_number(element, "Face", source) for element in names]
    _check(numbers, len(local_shape(source).Faces), "Face", source)
    return Region.of_faces(table, [f"Face{number}" for number in sorted(set(numbers))], name, **more)


def _check(numbers: list[int], count: int, kind: str, source) -> None:
    for number in numbers:
        if not 1 <= number <= count:
            raise BadInput(f"{source.Label} has no {kind}{number} any more, it has {count}: pick the faces again")
