"""How a carved object is shown: its icon, its place in the tree, its colours."""

from __future__ import annotations

from .qt import QtCore
from .resources import icon
from .stateless import Stateless


class CarvedView(Stateless):
    """What makes a view provider that of a carved object."""

    def __init__(self, view):
        view.Proxy = self
        view.DisplayMode = "Shaded"

    def attach(self, view) -> None:
        self._view = view
        # A file that is opened brings its colours before there is anything to show them with.
        self._show_colors_soon(view)

    def getIcon(self) -> str:
        return icon("Fretwork")

    def claimChildren(self) -> list:
        source = self._view.Object.Source
        return [source] if source else []

    def updateData(self, obj, name: str) -> None:
        if name in ("Mesh", "FaceColors", "Placement"):
            self._show_colors_soon(obj.ViewObject)

    def doubleClicked(self, view) -> bool:
        view.Document.setEdit(view.Object.Name)
        return True

    def setEdit(self, view, mode: int = 0) -> bool:
        if mode != 0:
            return None
        import FreeCADGui as Gui

        from .panel.carve_panel import CarvePanel

        Gui.Control.showDialog(CarvePanel(view.Object))
        return True

    def unsetEdit(self, view, mode: int = 0) -> bool:
        if mode != 0:
            return None
        import FreeCADGui as Gui

        Gui.Control.closeDialog()
        return True

    def onDelete(self, view, _names) -> bool:
        """With the carved object gone, its source is seen again."""
        from . import background

        background.stop(view.Object)
        source = view.Object.Source
        if source and source.ViewObject:
            source.ViewObject.Visibility = True
        return True

    def _show_colors_soon(self, view) -> None:
        # FreeCAD paints a changed mesh in one colour after it has told of the change, once for all changes at a time.
        if not getattr(self, "_waiting", False):
            self._waiting = True
            QtCore.QTimer.singleShot(0, lambda: self._show_colors(view))

    def _show_colors(self, view) -> None:
        self._waiting = False
        try:
            obj = view.Object
        except ReferenceError:
            return  # deleted meanwhile
        if obj and len(obj.FaceColors) == obj.Mesh.CountFacets > 0:
            view.Coloring = False
            view.Coloring = True

