"""How large, how thick, which way up, how fine."""

from __future__ import annotations

import random

import FreeCADGui as Gui

from ..qt import QtWidgets
from ..setting_properties import AUTOMATIC
from ..translation import translate
from .box import Box


class SizeBox(Box):
    """Writes the settings that most carvings are about; all others are in the property editor."""

    def __init__(self, obj):
        super().__init__(obj, "FretworkSize", translate("Size and look"))
        self._layout = QtWidgets.QFormLayout(self)
        self._quantity("ShellThickness", translate("Wall"), translate("0: as the size of the object asks"), 0.2)
        self._quantity("ExemplarWidth", translate("Width of a repeat"), translate("0: the pattern's own"), 5)
        self._quantity("SynthesisScale", translate("Scale"), translate("Of the pattern, against its normal size"), 0.1)
        self._choice("SynthesisOrientation", translate("Up in the picture"))
        self._choice("SynthesisPreset", translate("Quality"))
        self._choice("ShellSide", translate("Wall grows"))
        self._arrangement()

    def _quantity(self, name: str, label: str, tip: str, step: float) -> None:
        """A number with its unit, which takes expressions."""
        box = Gui.UiLoader().createWidget("Gui::QuantitySpinBox")
        box.setObjectName(f"Fretwork{name}")
        box.setToolTip(tip)
        box.setProperty("singleStep", step)
        box.setProperty("minimum", 0.0)
        value = getattr(self._obj, name)
        if hasattr(value, "Unit"):
            box.setProperty("unit", value.getUserPreferred()[2])
        box.setProperty("rawValue", getattr(value, "Value", value))
        Gui.ExpressionBinding(box).bind(self._obj, name)
        box.valueChanged.connect(lambda _: self._write(name, box.property("rawValue")))
        self._layout.addRow(label, box)

    def _choice(self, name: str, label: str) -> None:
        box = QtWidgets.QComboBox()
        box.setObjectName(f"Fretwork{name}")
        for choice in self._obj.getEnumerationsOfProperty(name):
            box.addItem(translate("automatic") if choice == AUTOMATIC else choice, choice)
        box.setCurrentIndex(box.findData(getattr(self._obj, name)))
        box.setToolTip(self._obj.getDocumentationOfProperty(name))
        box.currentIndexChanged[int].connect(lambda _: self._write(name, box.currentData()))
        self._layout.addRow(label, box)

    def _arrangement(self) -> None:
        """The seed, which nobody wants to read."""
        box = QtWidgets.QPushButton(translate("Another arrangement"))
        box.setObjectName("FretworkSeed")
        box.setToolTip(translate("The same pattern, laid out otherwise"))
        box.clicked.connect(lambda: self._write("SynthesisSeed", random.randrange(1, 10000)))
        self._layout.addRow("", box)

    def _write(self, name: str, value) -> None:
        now = getattr(self._obj, name)
        if getattr(now, "Value", now) != value:
            setattr(self._obj, name, value)
            self.changed.emit()
