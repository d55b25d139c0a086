"""Meshes that the engine wrote, as FreeCAD holds them."""

from __future__ import annotations

import struct
from pathlib import Path

import FreeCAD as App
import Mesh

# Each direction that can point up, as the turn that makes it z in the engine.
_TURNS = {
    "z": (0, 0, 0),
    "-z": (0, 0, 180),
    "x": (0, -90, 0),
    "-x": (0, 90, 0),
    "y": (0, 0, 90),
    "-y": (0, 0, -90),
}


def turn_of(up: str) -> App.Rotation:
    """How the engine turns a model whose `input.up` is this."""
    yaw, pitch, roll = _TURNS[up]
    return App.Rotation(yaw, pitch, roll)


def read_mesh(path: Path, up: str = "z") -> Mesh.Mesh:
    """The mesh in the coordinates of the model that was carved."""
    mesh = Mesh.Mesh()
    mesh.read(str(path))
    if up != "z":
        mesh.transform(App.Placement(App.Vector(), turn_of(up).inverted()).toMatrix())
    return mesh


def read_face_colors(path: Path) -> list[tuple[float, float, float]]:
    """The colours of the triangles of a PLY of the engine, which FreeCAD's own reader passes over; empty without."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    lines = header.decode("ascii").splitlines()
    if not any(line.endswith("uchar red") for line in lines):
        return []
    counts = {words[1]: int(words[2]) for words in map(str.split, lines) if words[0] == "element"}
    record = struct.Struct("<BIIIBBB")
    first = counts["vertex"] * struct.calcsize("<fff")
    palette = [value / 255 for value in range(256)]
    return [
        (palette[red], palette[green], palette[blue])
        for _, _, _, _, red, green, blue in record.iter_unpack(body[first : first + counts["face"] * record.size])
    ]
