"""What a carve is made from: the model, the pictures and the spec. Equal requests give equal results."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Mapping

from .spec import Region, spec_text


@dataclass(frozen=True)
class CarveRequest:
    """A model with settings."""

    model: bytes
    model_format: str  # extension of its file: "brep", "ply"
    model_name: str  # what the result calls it
    model_fingerprint: str  # equal for models that are the same
    values: Mapping[str, Any] = field(default_factory=dict)  # settings that are not as built in
    regions: tuple[Region, ...] = ()
    pictures: Mapping[str, tuple[str, bytes]] = field(default_factory=dict)  # "exemplar.image": (file name, bytes)

    def key(self) -> str:
        """A fingerprint of all that the result depends on."""
        digest = hashlib.sha256()
        for part in (self.model_format, self.model_fingerprint, spec_text(self.values, self.regions)):
            digest.update(part.encode() + b"\0")
        for key in sorted(self.pictures):
            picture = self.pictures[key][1]
            digest.update(key.encode() + len(picture).to_bytes(8, "little") + picture)
        return digest.hexdigest()


@dataclass(frozen=True)
class CarveFiles:
    """A request laid down in a folder, and where its results go."""

    model: Path
    spec: Path
    package: Path  # 3MF of a full run
    mesh: Path  # PLY with colours, of a draft or converted from the package
    summary: Path

    def draft_steps(self) -> list[list[str]]:
        """Arguments of the program, run after run, that make a draft."""
        return [[*self._carve(), "--preset", "draft", "-o", str(self.mesh)]]

    def full_steps(self) -> list[list[str]]:
        """The same for the whole result."""
        return [
            [*self._carve(), "-o", str(self.package)],
            ["convert", str(self.package), str(self.mesh), "--progress", "json"],
        ]

    def _carve(self) -> list[str]:
        return ["carve", str(self.model), "--pattern", str(self.spec), "--summary", str(self.summary),
                "--progress", "json"]  # fmt: skip


def file_name(name: str) -> str:
    """A name that every file system takes; nothing that a shell or a slicer stumbles over."""
    return re.sub(r"[^\w.+-]+", "_", name).strip("._-") or "model"


def lay_down(request: CarveRequest, folder: Path) -> CarveFiles:
    """Writes model, pictures and spec into a folder of their own."""
    name = file_name(request.model_name)
    model = folder / f"{name}.{request.model_format}"
    model.write_bytes(request.model)
    values = dict(request.values)
    for key, (picture_name, data) in request.pictures.items():
        # Picture and mask may have the same name.
        picture = folder / f"{key.split('.')[1]}_{file_name(picture_name)}"
        picture.write_bytes(data)
        values[key] = picture.name
    spec = folder / "spec.toml"
    spec.write_text(spec_text(values, request.regions), encoding="utf-8")
    results = folder / "out"
    results.mkdir(exist_ok=True)
    return CarveFiles(model, spec, results / f"{name}.3mf", results / f"{name}.ply", results / "summary.json")
