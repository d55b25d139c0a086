"""Which pattern: the built-in ones as pictures, or a picture of the user's own."""

from __future__ import annotations

from ..preferences import engine
from ..qt import QtCore, QtGui, QtWidgets
from ..setting_properties import OWN_PICTURE
from ..thumbnails import Thumbnails
from ..translation import translate
from .box import Box

_ICON_PX = 88


class PatternBox(Box):
    """Writes ExemplarPattern and ExemplarImage."""

    def __init__(self, obj):
        super().__init__(obj, "FretworkPattern", translate("Pattern"))
        self.list = _picture_list()
        self._description = QtWidgets.QLabel()
        self._description.setWordWrap(True)
        own = QtWidgets.QPushButton(translate("Own picture..."))
        own.setToolTip(translate("A PNG or JPEG: dark is solid, or what a mask or transparency says"))
        own.clicked.connect(self._ask_for_picture)
        layout = QtWidgets.QVBoxLayout(self)
        for widget in (self.list, self._description, own):
            layout.addWidget(widget)
        self._fill()
        self._thumbnails = Thumbnails([pattern.name for pattern in engine().patterns], self)
        self._thumbnails.ready.connect(self._show_thumbnail)
        self._thumbnails.start()
        self._show_chosen()
        self.list.currentItemChanged.connect(self._choose)

    def close_box(self) -> None:
        self._thumbnails.stop()

    def take_picture(self, path: str) -> None:
        """Takes a picture of the user's own as the pattern."""
        self._obj.ExemplarImage = path
        self._obj.ExemplarPattern = OWN_PICTURE
        self._show_chosen()
        self.changed.emit()

    def _fill(self) -> None:
        for pattern in engine().patterns:
            item = _picture_item(pattern.name, pattern.name)
            item.setToolTip(pattern.description)
            self.list.addItem(item)

    def _show_thumbnail(self, name: str, picture) -> None:
        item = self._item(name)
        if item:
            item.setIcon(QtGui.QIcon(QtGui.QPixmap.fromImage(picture)))

    def _item(self, name: str):
        for row in range(self.list.count()):
            if self.list.item(row).data(QtCore.Qt.UserRole) == name:
                return self.list.item(row)
        return None

    def _show_chosen(self) -> None:
        """Marks what the object has."""
        self.list.blockSignals(True)
        chosen = self._obj.ExemplarPattern
        if self._obj.ExemplarImage:
            item = self._item(OWN_PICTURE)
            if not item:
                item = _picture_item(translate("own picture"), OWN_PICTURE)
                self.list.insertItem(0, item)
            item.setIcon(QtGui.QIcon(self._obj.ExemplarImage))
        self.list.setCurrentItem(self._item(chosen))
        self.list.blockSignals(False)
        self._describe()

    def _describe(self) -> None:
        item = self.list.currentItem()
        self._description.setText(item.toolTip() if item else translate("Choose a pattern"))

    def _choose(self, item, _before) -> None:
        if item:
            self._obj.ExemplarPattern = item.data(QtCore.Qt.UserRole)
            self._describe()
            self.changed.emit()

    def _ask_for_picture(self) -> None:
        pictures = translate("Pictures") + " (*.png *.jpg *.jpeg)"
        path, _ = QtWidgets.QFileDialog.getOpenFileName(self, translate("Own picture"), "", pictures)
        if path:
            self.take_picture(path)


def _picture_item(label: str, choice: str):
    item = QtWidgets.QListWidgetItem(label)
    item.setData(QtCore.Qt.UserRole, choice)
    # Pictures come later; without a size the list would make room for the label alone.
    item.setSizeHint(QtCore.QSize(_ICON_PX + 10, _ICON_PX + 24))
    return item


def _picture_list():
    view = QtWidgets.QListWidget()
    view.setObjectName("FretworkPatterns")
    view.setViewMode(QtWidgets.QListView.IconMode)
    view.setIconSize(QtCore.QSize(_ICON_PX, _ICON_PX))
    view.setGridSize(QtCore.QSize(_ICON_PX + 10, _ICON_PX + 24))
    view.setResizeMode(QtWidgets.QListView.Adjust)
    view.setMovement(QtWidgets.QListView.Static)
    view.setMinimumHeight(2 * (_ICON_PX + 28))
    return view
