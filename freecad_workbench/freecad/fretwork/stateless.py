"""Python halves of document objects that keep nothing of their own."""

from __future__ import annotations


class Stateless:
    """All that is to be saved is in the properties of the object."""

    def dumps(self):
        return None

    def loads(self, state) -> None:
        pass

    # FreeCAD 0.20 calls them by these names.
    __getstate__, __setstate__ = dumps, loads
