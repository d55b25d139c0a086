"""Which faces are carved and which stay solid, picked in the view."""

from __future__ import annotations

import FreeCAD as App
import FreeCADGui as Gui

from ..qt import QtCore, QtWidgets
from ..selection import source_behind
from ..source import element_names, is_mesh, linked
from ..translation import translate
from .box import Box

# Red, green, blue and transparency of picked faces.
CARVE_COLOR, KEEP_COLOR = (0.91, 0.58, 0.36, 0.0), (0.45, 0.62, 0.81, 0.0)
_PLAIN_COLOR = (0.8, 0.8, 0.8, 0.0)


def _shown(source):
    """The object whose view shows the faces of a source: of a body it is the tip. None where faces are not shown
    one by one."""
    shown = getattr(linked(source), "Tip", None) or linked(source)
    return shown if hasattr(shown.ViewObject, "DiffuseColor") and not is_mesh(source) else None


class FacePicker(QtWidgets.QWidget):
    """A list of faces that a click into the view adds to or takes from."""

    changed = QtCore.Signal()
    picking = QtCore.Signal(bool)

    def __init__(self, obj, name: str, label: str, none: str, tip: str):
        super().__init__()
        self.name = name
        self._obj, self._none = obj, none
        self._text = QtWidgets.QLabel()
        self._text.setWordWrap(True)
        self.button = QtWidgets.QToolButton()
        self.button.setText(translate("Pick"))
        self.button.setCheckable(True)
        self.button.setObjectName(f"Fretwork{name}")
        self.button.setToolTip(tip)
        self.button.setEnabled(_shown(obj.Source) is not None)
        self.button.toggled.connect(self.picking.emit)
        clear = QtWidgets.QToolButton()
        clear.setText(translate("Clear"))
        clear.clicked.connect(lambda: self.set_faces([]))
        layout = QtWidgets.QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(QtWidgets.QLabel(label))
        layout.addWidget(self._text, 1)
        layout.addWidget(self.button)
        layout.addWidget(clear)
        self._show()

    def faces(self) -> list[str]:
        return element_names(getattr(self._obj, self.name), self._obj.Source)

    def set_faces(self, names: list[str]) -> None:
        setattr(self._obj, self.name, [(self._obj.Source, tuple(names))] if names else [])
        self._show()
        self.changed.emit()

    def toggle(self, name: str) -> None:
        """Adds a face, or takes it away where it is in the list."""
        names = self.faces()
        self.set_faces([other for other in names if other != name] if name in names else [*names, name])

    def _show(self) -> None:
        self._text.setText(", ".join(self.faces()) or self._none)


class FacesBox(Box):
    """Writes CarveFaces and KeepFaces. While faces are picked the source is seen, with its picked faces in colour."""

    def __init__(self, obj):
        super().__init__(obj, "FretworkFaces", translate("Faces"))
        self._before: tuple | None = None
        self._pickers = [
            FacePicker(obj, "CarveFaces", translate("Carve"), translate("the whole surface"),
                       translate("Click faces in the view: only these are carved")),
            FacePicker(obj, "KeepFaces", translate("Keep solid"), translate("none"),
                       translate("Click faces in the view: these stay solid")),
        ]  # fmt: skip
        layout = QtWidgets.QVBoxLayout(self)
        for picker in self._pickers:
            layout.addWidget(picker)
            picker.changed.connect(self._faces_changed)
            picker.picking.connect(lambda on, which=picker: self._pick(which, on))
        if not _shown(obj.Source):
            layout.addWidget(QtWidgets.QLabel(translate("This object has no faces to pick.")))

    def close_box(self) -> None:
        for picker in self._pickers:
            picker.button.setChecked(False)

    # --- FreeCAD's selection calls this ---

    def addSelection(self, document: str, name: str, element: str, _point) -> None:
        picked = App.getDocument(document).getObject(name)
        face = element.rsplit(".", 1)[-1]
        if face.startswith("Face") and source_behind(picked, element) == self._obj.Source:
            for picker in self._pickers:
                if picker.button.isChecked():
                    picker.toggle(face)
            # So that the next click on the same face is told again.
            QtCore.QTimer.singleShot(0, Gui.Selection.clearSelection)

    def _faces_changed(self) -> None:
        self._color()
        self.changed.emit()

    def _pick(self, which: FacePicker, on: bool) -> None:
        if on:
            for other in self._pickers:
                if other is not which:
                    other.button.setChecked(False)
            self._begin()
        elif not any(picker.button.isChecked() for picker in self._pickers):
            self._end()

    def _begin(self) -> None:
        source, carved = self._obj.Source.ViewObject, self._obj.ViewObject
        self._before = (source.Visibility, carved.Visibility, _shown(self._obj.Source).ViewObject.DiffuseColor)
        source.Visibility, carved.Visibility = True, False
        Gui.Selection.clearSelection()
        Gui.Selection.addObserver(self)
        self._color()

    def _end(self) -> None:
        Gui.Selection.removeObserver(self)
        source_seen, carved_seen, colors = self._before
        self._before = None
        _shown(self._obj.Source).ViewObject.DiffuseColor = colors
        self._obj.Source.ViewObject.Visibility = source_seen
        self._obj.ViewObject.Visibility = carved_seen

    def _color(self) -> None:
        if self._before is None:
            return
        shown = _shown(self._obj.Source)
        colors = [_PLAIN_COLOR] * len(shown.Shape.Faces)
        for picker, color in zip(self._pickers, (CARVE_COLOR, KEEP_COLOR)):
            for name in picker.faces():
                colors[int(name[4:]) - 1] = color
        shown.ViewObject.DiffuseColor = colors
