"""Settings of the engine as properties of an object: typed, documented, usable in expressions.

Nothing here names a setting that is treated like all others: what there is comes from the engine's schema, so that an
engine with a new key gives its objects a new property.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import FreeCAD as App

from .engine.schema import BOOLEAN, CHOICE, DIRECTION, INTEGER, ORIENTATION, TEXT, Schema, Setting

AUTOMATIC = "automatic"
OWN_PICTURE = "own picture"
OWN_DIRECTION = "direction"

# What says which of several files or objects to take, or how large a file without units is: a document knows.
_OF_FILES = {"input.scale", "input.size_mm", "input.objects", "input.ignore_required"}
PICTURES = ("exemplar.image", "exemplar.mask")
PATTERN = "exemplar.pattern"

_MOST_INTEGER = 2**31 - 1

# unit: (suffix of the key, type of the property, unit of its value)
_QUANTITIES = {
    "mm": ("_mm", "App::PropertyLength", "mm"),
    "deg": ("_deg", "App::PropertyAngle", "deg"),
    "degrees": ("_deg", "App::PropertyAngle", "deg"),
    "N": ("_n", "App::PropertyForce", "N"),
    "MPa": ("_mpa", "App::PropertyPressure", "MPa"),
}


def _bare_name(setting: Setting) -> str:
    return setting.name.removesuffix(_QUANTITIES[setting.unit][0]) if setting.unit in _QUANTITIES else setting.name


@dataclass(frozen=True)
class SettingProperty:
    """A setting and the property that holds it."""

    setting: Setting
    patterns: tuple[str, ...] = ()  # names to choose from, of the setting that names a pattern

    @property
    def name(self) -> str:
        """`shell.thickness_mm` is ShellThickness."""
        words = f"{self.setting.section}_{_bare_name(self.setting)}".split("_")
        return "".join(word[:1].upper() + word[1:] for word in words)

    @property
    def group(self) -> str:
        return self.setting.section.capitalize()

    @property
    def automatic(self) -> float:
        """The number that leaves the choice to the engine: one that is no value of the setting."""
        takes_zero = self.setting.minimum is None or (self.setting.minimum <= 0 and not self.setting.open_minimum)
        return -1 if takes_zero else 0

    @property
    def type(self) -> str:
        """FreeCAD's type of the property."""
        setting = self.setting
        if setting.key in PICTURES:
            return "App::PropertyFileIncluded"
        if self.choices:
            return "App::PropertyEnumeration"
        if setting.unit in _QUANTITIES:
            return _QUANTITIES[setting.unit][1]
        return {
            BOOLEAN: "App::PropertyBool",
            TEXT: "App::PropertyString",
            DIRECTION: "App::PropertyVector",
            INTEGER: "App::PropertyIntegerConstraint",
        }.get(setting.kind, "App::PropertyFloatConstraint")

    @property
    def choices(self) -> list[str]:
        """Values of an enumeration; empty for all that is none."""
        setting = self.setting
        if setting.key == PATTERN:
            return [OWN_PICTURE, *self.patterns]
        if setting.kind == ORIENTATION:
            return [*setting.choices, OWN_DIRECTION]
        choices = list(setting.choices)
        if setting.kind == BOOLEAN and setting.optional:
            choices = ["yes", "no"]
        return [AUTOMATIC, *choices] if choices and setting.optional else choices

    @property
    def help(self) -> str:
        """The tool tip."""
        setting = self.setting
        text = f"{setting.help} [{setting.key}]"
        if setting.unit and setting.unit not in _QUANTITIES:
            text += f"\nUnit: {setting.unit}."
        if setting.optional and setting.default_text and setting.key not in (PATTERN, *PICTURES):
            unset = AUTOMATIC if self.choices else "empty" if setting.kind == TEXT else f"{self.automatic:g}"
            text += f"\n{unset}: {setting.default_text}."
        return text

    def add_to(self, obj) -> bool:
        """Adds the property where it is not there yet; says whether it did."""
        missing = self.name not in obj.PropertiesList
        if missing:
            obj.addProperty(self.type, self.name, self.group, self.help)
            if self.choices:
                setattr(obj, self.name, self.choices)
            if self.setting.kind == ORIENTATION:
                obj.addProperty("App::PropertyVector", self.name + "Direction", self.group,
                                f"Used where {self.name} is '{OWN_DIRECTION}'")  # fmt: skip
                setattr(obj, self.name + "Direction", App.Vector(0, 0, 1))
        elif self.choices:
            self._renew_choices(obj)
        self._set_range(obj)
        if missing:
            self.reset(obj)
        return missing

    def _renew_choices(self, obj) -> None:
        """An engine may know patterns that the one that made the object did not; what is chosen stays."""
        chosen, known = getattr(obj, self.name), self.choices
        if obj.getEnumerationsOfProperty(self.name) != known:
            setattr(obj, self.name, known if chosen in known else [*known, chosen])
            setattr(obj, self.name, chosen)

    def _set_range(self, obj) -> None:
        """FreeCAD does not keep the range of a number in its files."""
        setting = self.setting
        lowest = setting.minimum if setting.minimum is not None else -1e9
        if setting.optional:
            lowest = min(lowest, self.automatic)
        highest = setting.maximum if setting.maximum is not None else 1e9
        now = getattr(obj, self.name)
        if self.type == "App::PropertyIntegerConstraint":
            setattr(obj, self.name, (now, int(lowest), min(int(highest), _MOST_INTEGER), 1))
        elif self.type == "App::PropertyFloatConstraint":
            setattr(obj, self.name, (now, float(lowest), float(highest), 0.1))

    def reset(self, obj) -> None:
        """Back to what is built in."""
        if self.type == "App::PropertyFileIncluded":
            setattr(obj, self.name, "")
        else:
            self.write(obj, self.setting.default)

    def write(self, obj, value: Any) -> None:
        """Gives the property the value of a spec; None leaves it to the engine."""
        setting = self.setting
        if self.choices:
            self._write_choice(obj, value)
        elif value is None:
            setattr(obj, self.name, "" if setting.kind == TEXT else self.automatic)
        elif setting.kind == DIRECTION:
            setattr(obj, self.name, App.Vector(*value))
        elif setting.unit in _QUANTITIES:
            setattr(obj, self.name, App.Units.Quantity(f"{value!r} {_QUANTITIES[setting.unit][2]}"))
        elif setting.kind in (INTEGER, BOOLEAN, TEXT):
            setattr(obj, self.name, value)
        else:
            setattr(obj, self.name, float(value))

    def _write_choice(self, obj, value: Any) -> None:
        if self.setting.kind == ORIENTATION and not isinstance(value, str):
            setattr(obj, self.name + "Direction", App.Vector(*value))
            value = OWN_DIRECTION
        elif isinstance(value, bool):
            value = "yes" if value else "no"
        elif value is None:
            value = OWN_PICTURE if self.setting.key == PATTERN else AUTOMATIC
        setattr(obj, self.name, value)

    def read(self, obj) -> Any:
        """The value for a spec; None where the engine decides."""
        setting = self.setting
        value = getattr(obj, self.name)
        if self.choices:
            return self._read_choice(obj, value)
        if setting.kind == DIRECTION:
            return [value.x, value.y, value.z]
        if setting.unit in _QUANTITIES:
            # Written and read again a length may differ in its last bit.
            value = float(f"{value.getValueAs(_QUANTITIES[setting.unit][2]).Value:.12g}")
        if setting.optional and value in ("", self.automatic):
            return None
        return value

    def _read_choice(self, obj, value: str) -> Any:
        if value in (AUTOMATIC, OWN_PICTURE):
            return None
        if self.setting.kind == ORIENTATION and value == OWN_DIRECTION:
            direction = getattr(obj, self.name + "Direction")
            return [direction.x, direction.y, direction.z]
        return value == "yes" if self.setting.kind == BOOLEAN else value

    def is_default(self, value: Any) -> bool:
        """Whether a value that was read need not stand in a spec."""
        default = self.setting.default
        if isinstance(value, float) and isinstance(default, (int, float)):
            return math.isclose(value, default, rel_tol=1e-9, abs_tol=1e-12)
        return value == default


def setting_properties(schema: Schema, patterns: list[str]) -> list[SettingProperty]:
    """The properties that a carved object has for its settings, in the order of the schema."""
    return [
        SettingProperty(setting, tuple(patterns) if setting.key == PATTERN else ())
        for setting in schema
        if setting.key not in _OF_FILES
    ]


def changed_values(obj, properties: list[SettingProperty]) -> dict[str, Any]:
    """What is not as built in, by key: the values of a spec. Pictures are left out, for they are files."""
    values = {}
    for entry in properties:
        if entry.setting.key in PICTURES or entry.name not in obj.PropertiesList:
            continue
        value = entry.read(obj)
        if not entry.is_default(value):
            values[entry.setting.key] = value
    return values
