"""Settings as properties: `freecadcmd -t freecad.fretwork.tests.test_settings`."""

from __future__ import annotations

import json

import FreeCAD as App

from ..carved import Carved, properties_of_settings
from ..engine.schema import BOOLEAN, DIRECTION, INTEGER, ORIENTATION, TEXT
from ..engine.spec import spec_text
from ..migration import migrate
from ..preferences import engine
from ..setting_properties import PATTERN, PICTURES, changed_values
from .support import DocumentTest


def _samples(entry) -> list:
    """Values from all over the range of a setting."""
    setting = entry.setting
    if setting.key == PATTERN:
        return ["cells", "waves", None]
    if setting.kind == ORIENTATION:
        return ["up", "free", [0.0, 1.0, 0.5]]
    if setting.choices:
        return list(setting.choices)
    if setting.kind == BOOLEAN:
        return [True, False]
    if setting.kind == TEXT:
        return ["PETG", "resin"]
    if setting.kind == DIRECTION:
        return [[1.0, 0.0, 0.0], [0.25, -3.0, 1e-3]]
    low = setting.minimum if not setting.open_minimum else 1e-3
    high = min(setting.maximum, 2**31 - 1)
    # A third of it is no number of few digits; twelve of them are kept.
    numbers = [low, float(f"{(low + high) / 3:.12g}"), high]
    return [int(number) for number in numbers] if setting.kind == INTEGER else [float(number) for number in numbers]


class SettingsAsProperties(DocumentTest):
    def setUp(self):
        super().setUp()
        self.obj = self.document.addObject("Mesh::FeaturePython", "Carved")
        Carved(self.obj)
        self.entries = properties_of_settings()

    def test_every_key_has_a_property_but_those_that_only_files_need(self):
        keys = {entry.setting.key for entry in self.entries}
        self.assertEqual(
            set(engine().schema.keys()) - keys,
            {"input.scale", "input.size_mm", "input.objects", "input.ignore_required"},
        )
        names = [entry.name for entry in self.entries]
        self.assertEqual(len(names), len(set(names)))
        for entry in self.entries:
            self.assertEqual(self.obj.getTypeIdOfProperty(entry.name), entry.type, entry.setting.key)
            self.assertIn(entry.setting.help, self.obj.getDocumentationOfProperty(entry.name))

    def test_types_carry_units(self):
        types = {entry.setting.key: (entry.name, entry.type) for entry in self.entries}
        self.assertEqual(types["shell.thickness_mm"], ("ShellThickness", "App::PropertyLength"))
        self.assertEqual(types["synthesis.cone_deg"], ("SynthesisCone", "App::PropertyAngle"))
        self.assertEqual(types["structure.handling_force_n"], ("StructureHandlingForce", "App::PropertyForce"))
        self.assertEqual(types["structure.strength_mpa"], ("StructureStrength", "App::PropertyPressure"))
        self.obj.ShellThickness = "0.25 in"
        self.assertEqual(changed_values(self.obj, self.entries), {"shell.thickness_mm": 6.35})

    def test_as_made_nothing_differs_from_what_is_built_in(self):
        self.assertEqual(changed_values(self.obj, self.entries), {})

    def test_what_is_written_is_read_again_and_the_engine_takes_it(self):
        for entry in self.entries:
            if entry.setting.key in PICTURES:
                continue
            for value in _samples(entry):
                entry.write(self.obj, value)
                read = entry.read(self.obj)
                self.assertEqual(read, value, entry.setting.key)
                if value is not None and entry.setting.key != "structure.gravity":
                    self._check({"exemplar.pattern": "cells", entry.setting.key: value}, entry.setting.key)
            entry.reset(self.obj)
            self.assertTrue(entry.is_default(entry.read(self.obj)), entry.setting.key)

    def _check(self, values, key):
        """The program reads the spec; a value alone may contradict the defaults of others, which `info` lets be."""
        path = self.folder / "spec.toml"
        path.write_text(spec_text(values))
        read = json.loads(engine().run(["info", str(path), "--json"]))["changed"]
        section, name = key.split(".")
        default = engine().schema[key].default
        self.assertEqual(read.get(section, {}).get(name, default), values[key], key)

    def test_numbers_stay_in_their_range_after_reopening(self):
        for name in ("", "file.FCStd"):
            obj = (self.reopened(name) if name else self.document).Carved
            obj.SynthesisJitter = 7.0
            self.assertEqual(obj.SynthesisJitter, 1.0)
            obj.SynthesisCandidates = -5
            self.assertEqual(obj.SynthesisCandidates, 1)
            obj.SynthesisJitter, obj.SynthesisCandidates = 0.5, 17
        self.assertEqual(
            changed_values(self.reopened("again.FCStd").Carved, self.entries),
            {"synthesis.jitter": 0.5, "synthesis.candidates": 17},
        )

    def test_expressions_drive_settings(self):
        self.shape(name="Box")
        self.obj.setExpression("ShellThickness", "Box.Shape.BoundBox.XLength / 20")
        self.obj.setExpression("SynthesisSeed", "3 + 4")
        self.obj.Update = "By request"
        self.obj.Source = self.document.Box
        self.document.recompute()
        self.assertEqual(
            changed_values(self.obj, self.entries), {"shell.thickness_mm": 3.0, "synthesis.seed": 7}
        )

    def test_an_older_object_gets_what_it_lacks_and_keeps_what_it_has(self):
        self.obj.SynthesisSeed = 5
        self.obj.addProperty("App::PropertyLength", "WallThickness", "Old")
        self.obj.WallThickness = 2.5
        self.obj.removeProperty("SynthesisScale")
        self.obj.MadeBy = "0.0.1"
        self.obj.Proxy.onDocumentRestored(self.obj)
        self.assertEqual((self.obj.SynthesisSeed, self.obj.SynthesisScale), (5, 1.0))
        self.assertEqual(self.obj.MadeBy, "0.1.0")
        migrate(self.obj, {"WallThickness": "ShellThickness"})
        self.assertEqual(self.obj.ShellThickness, App.Units.Quantity("2.5 mm"))
        self.assertNotIn("WallThickness", self.obj.PropertiesList)

    def test_a_pattern_that_the_engine_no_longer_has_stays_chosen(self):
        self.obj.ExemplarPattern = ["own picture", "cells", "vanished"]
        self.obj.ExemplarPattern = "vanished"
        self.obj.Proxy.onDocumentRestored(self.obj)
        self.assertEqual(self.obj.ExemplarPattern, "vanished")
        self.assertIn("waves", self.obj.getEnumerationsOfProperty("ExemplarPattern"))
