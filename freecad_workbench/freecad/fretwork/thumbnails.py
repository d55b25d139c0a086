"""Pictures of the built-in patterns: each on a vase, made by the engine when first needed and kept for later."""

from __future__ import annotations

from pathlib import Path

import FreeCAD as App

from .preferences import engine
from .program_process import ProgramProcess
from .qt import QtCore, QtGui

SIDE_PX = 160


def folder() -> Path:
    """Where they are kept; another version of the engine draws its own."""
    path = Path(App.getUserCachePath()) / "Fretwork" / f"patterns-{engine().version}"
    path.mkdir(parents=True, exist_ok=True)
    return path


class Thumbnails(QtCore.QObject):
    """Tells of pictures as they become ready: of what there is at once, of the rest one after the other.

    A pattern that has not been drawn yet is first shown flat, which takes no time.
    """

    ready = QtCore.Signal(str, QtGui.QImage)

    def __init__(self, names: list[str], parent=None):
        super().__init__(parent)
        self._folder = folder()
        self._process: ProgramProcess | None = None
        missing = [name for name in names if not self._kept(name).exists()]
        self._waiting = [("show", name) for name in missing] + [("preview", name) for name in missing]
        self._shown = [name for name in names if name not in missing]

    def start(self) -> None:
        for name in self._shown:
            self.ready.emit(name, QtGui.QImage(str(self._kept(name))))
        self._next()

    def stop(self) -> None:
        """What is not ready yet is left for the next time."""
        self._waiting.clear()
        if self._process:
            self._process.stop()

    def _kept(self, name: str) -> Path:
        return self._folder / f"{name}.png"

    def _next(self) -> None:
        if not self._waiting:
            return
        how, name = self._waiting.pop(0)
        self._made = self._folder / f".{name}.png"
        self._process = ProgramProcess(engine().program, ["pattern", how, name, "-o", str(self._made)], self)
        self._process.succeeded.connect(lambda: self._take(how, name))
        self._process.failed.connect(lambda _: self._next())
        self._process.start()

    def _take(self, how: str, name: str) -> None:
        smooth = QtCore.Qt.SmoothTransformation
        picture = QtGui.QImage(str(self._made)).scaled(SIDE_PX, SIDE_PX, QtCore.Qt.KeepAspectRatio, smooth)
        self._made.unlink()
        if how == "preview":
            picture.save(str(self._kept(name)))
        self.ready.emit(name, picture)
        self._next()
