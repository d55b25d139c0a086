"""Objects of older versions, brought up to this one."""

from __future__ import annotations

VERSION = "0.1.0"

# Properties that were called otherwise before: {old name: new name}.
_RENAMED: dict[str, str] = {}


def migrate(obj, renamed: dict[str, str] = _RENAMED) -> None:
    """Hands the values of properties that have a new name on to it, and drops the old ones."""
    for old, new in renamed.items():
        if old in obj.PropertiesList:
            if new in obj.PropertiesList:
                setattr(obj, new, getattr(obj, old))
            obj.removeProperty(old)
    obj.MadeBy = VERSION
