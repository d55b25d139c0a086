"""The settings of a spec, read from the program's own schema (`fretwork spec schema`)."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Iterator

CHOICE, NUMBER, INTEGER, BOOLEAN, TEXT, DIRECTION, ORIENTATION = (
    "choice", "number", "integer", "boolean", "text", "direction", "orientation",
)  # fmt: skip



@dataclass(frozen=True)
class Setting:
    """One key of a spec."""

    key: str  # "shell.thickness_mm"
    kind: str
    help: str
    default: Any  # None: the engine decides unless a value is given
    default_text: str  # what it then decides, in words; empty where there is a default
    unit: str
    minimum: float | None
    maximum: float | None
    open_minimum: bool  # the minimum itself is out of range
    choices: tuple[str, ...]

    @property
    def section(self) -> str:
        return self.key.split(".")[0]

    @property
    def name(self) -> str:
        return self.key.split(".")[1]

    @property
    def optional(self) -> bool:
        """Whether the engine decides where no value is given."""
        return self.default is None


def _kind(entry: dict) -> tuple[str, tuple[str, ...]]:
    if "enum" in entry:
        return CHOICE, tuple(entry["enum"])
    if "anyOf" in entry:
        return ORIENTATION, tuple(entry["anyOf"][0]["enum"])
    kinds = {"number": NUMBER, "integer": INTEGER, "boolean": BOOLEAN, "string": TEXT, "array": DIRECTION}
    return kinds[entry["type"]], ()


def _setting(key: str, entry: dict) -> Setting:
    kind, choices = _kind(entry)
    exclusive = entry.get("exclusiveMinimum")
    return Setting(
        key=key,
        kind=kind,
        help=entry["description"],
        default=entry.get("default"),
        default_text=entry.get("x-default", ""),
        unit=entry.get("x-unit", ""),
        minimum=entry.get("minimum", exclusive),
        maximum=entry.get("maximum"),
        open_minimum=exclusive is not None,
        choices=choices,
    )


def _is_section(entry: dict) -> bool:
    return entry.get("type") == "object" and "properties" in entry


@dataclass(frozen=True)
class Schema:
    """All settings, in the order of the schema."""

    settings: tuple[Setting, ...]

    def __iter__(self) -> Iterator[Setting]:
        return iter(self.settings)

    def __getitem__(self, key: str) -> Setting:
        for setting in self.settings:
            if setting.key == key:
                return setting
        raise KeyError(key)

    def keys(self) -> list[str]:
        return [setting.key for setting in self.settings]


def parse_schema(text: str | bytes) -> Schema:
    """Reads what `fretwork spec schema` prints; tables of regions are left out."""
    found = []
    for section, body in json.loads(text)["properties"].items():
        if _is_section(body):
            found += [_setting(f"{section}.{name}", entry) for name, entry in body["properties"].items()]
    return Schema(tuple(found))
