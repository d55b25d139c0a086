"""Specs as text: values of settings, and the regions that are kept, carved, loaded and held."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any, Iterable, Mapping

KEEP, CARVE, LOADS, FIXTURES = "keep", "carve", "loads", "fixtures"


@dataclass(frozen=True)
class Region:
    """One entry of [[keep]], [[carve]], [[loads]] or [[fixtures]] (docs/spec.md, regions)."""

    table: str
    shape: str
    fields: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""

    @staticmethod
    def of_faces(table: str, names: Iterable[str], name: str = "", **more: Any) -> Region:
        """Faces of a CAD model."""
        return Region(table, "named", {"names": ", ".join(names), **more}, name)

    @staticmethod
    def of_triangles(table: str, triangles: Iterable[int], name: str = "", **more: Any) -> Region:
        """Triangles of a mesh, by number."""
        return Region(table, "triangles", {"triangles": sorted(triangles), **more}, name)


def _value_text(value: Any) -> str:
    # A JSON string is a TOML string; numbers, booleans and lists look the same in both.
    return json.dumps(list(value) if isinstance(value, tuple) else value, ensure_ascii=False)


def spec_text(values: Mapping[str, Any], regions: Iterable[Region] = ()) -> str:
    """A spec in TOML. The same values and regions give the same text."""
    lines: list[str] = []
    section = ""
    for key in sorted(values):
        before, name = key.split(".")
        if before != section:
            section = before
            lines += [f"[{section}]"]
        lines.append(f"{name} = {_value_text(values[key])}")
    for region in regions:
        lines.append(f"[[{region.table}]]")
        if region.name:
            lines.append(f"name = {_value_text(region.name)}")
        lines.append(f"shape = {_value_text(region.shape)}")
        lines += [f"{key} = {_value_text(value)}" for key, value in region.fields.items()]
    return "\n".join(lines) + "\n"
