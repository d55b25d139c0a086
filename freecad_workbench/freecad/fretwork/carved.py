"""The carved object: a mesh that follows a source, faces, a pattern and the settings of the engine.

Its document object is a Mesh::FeaturePython, so that it shows, exports and selects as any mesh. A recompute makes a
draft, which takes seconds; the full run comes by request and is kept with its 3MF package in the document.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import FreeCAD as App

from . import migration
from .engine.errors import BadInput, BadSettings, EngineError
from .engine.request import CarveRequest
from .engine.spec import CARVE, KEEP, Region
from .engine.summary import summary_lines, warning_lines
from .mesh_files import read_face_colors, read_mesh
from .preferences import engine
from .results import Result, failure, make, remembered
from .setting_properties import OWN_PICTURE, PICTURES, SettingProperty, changed_values, setting_properties
from .source import model_of, region_of, same_placement
from .stateless import Stateless
from .strength_check import Strength
from .translation import noop

TYPE = "Fretwork::Carved"
DRAFT_AUTOMATICALLY, BY_REQUEST = "Draft automatically", "By request"

# What an object shows, as its property State says.
NOT_CARVED, DRAFT, CARVED, OUTDATED, FAILED = "not carved", "draft", "carved", "out of date", "failed"

_READ_ONLY, _OUT_OF_SIGHT = 1, 1 | 4

# (type, name, group, help, flags, first value)
_PROPERTIES = (
    ("App::PropertyLinkGlobal", "Source", "Fretwork",
     noop("App::Property", "The body, shape or mesh that is carved"), 0, None),
    ("App::PropertyLinkSubListGlobal", "CarveFaces", "Fretwork",
     noop("App::Property", "Faces that are carved, all others stay solid; none: the whole surface is carved"), 0, None),
    ("App::PropertyLinkSubListGlobal", "KeepFaces", "Fretwork",
     noop("App::Property", "Faces that stay solid"), 0, None),
    ("App::PropertyEnumeration", "Update", "Fretwork",
     noop("App::Property", "What a recompute does: make a draft, or leave the object as it is until it is asked for"),
     0, [DRAFT_AUTOMATICALLY, BY_REQUEST]),
    ("App::PropertyBool", "FollowSource", "Fretwork",
     noop("App::Property", "Whether the object is placed as its source is"), 0, True),
    ("App::PropertyString", "State", "Result",
     noop("App::Property", "What the object shows"), _READ_ONLY, NOT_CARVED),
    ("App::PropertyStringList", "Summary", "Result",
     noop("App::Property", "What came of the run"), _READ_ONLY, None),
    ("App::PropertyStringList", "Warnings", "Result",
     noop("App::Property", "What to know before it is printed"), _READ_ONLY, None),
    ("App::PropertyVolume", "Material", "Result",
     noop("App::Property", "Volume of what is printed"), _READ_ONLY, None),
    ("App::PropertyPercent", "SolidShare", "Result",
     noop("App::Property", "How much of the carved surface is solid"), _READ_ONLY, None),
    ("App::PropertyStringList", "Strength", "Result",
     noop("App::Property", "What the full analysis says of the result"), _READ_ONLY, None),
    ("App::PropertyBool", "ShowStress", "Result",
     noop("App::Property", "Whether the object is shown in the colours of its stress"), 0, False),
    ("App::PropertyFileIncluded", "Package", "Result",
     noop("App::Property", "The 3MF of the last full run"), _OUT_OF_SIGHT, None),
    ("App::PropertyString", "PackageKey", "Result",
     noop("App::Property", "Fingerprint of what the package was made from"), _OUT_OF_SIGHT, None),
    ("App::PropertyString", "Report", "Result",
     noop("App::Property", "The report of the run, JSON"), _OUT_OF_SIGHT, None),
    ("App::PropertyString", "ResultKey", "Result",
     noop("App::Property", "Fingerprint of what the result was made from"), _OUT_OF_SIGHT, None),
    ("App::PropertyColorList", "FaceColors", "Result",
     noop("App::Property", "Colours of the triangles"), _OUT_OF_SIGHT, None),
    ("App::PropertyColorList", "PatternColors", "Result",
     noop("App::Property", "Colours of the pattern"), _OUT_OF_SIGHT, None),
    ("App::PropertyColorList", "StressColors", "Result",
     noop("App::Property", "Colours of the stress"), _OUT_OF_SIGHT, None),
    ("App::PropertyString", "MadeBy", "Result",
     noop("App::Property", "Version of the workbench that made the object"), _OUT_OF_SIGHT, migration.VERSION),
)  # fmt: skip


def is_carved(obj) -> bool:
    """Whether an object of a document is one of these."""
    return getattr(getattr(obj, "Proxy", None), "Type", "") == TYPE


def properties_of_settings() -> list[SettingProperty]:
    """The properties that follow from the engine's schema. Raises EngineError where there is no engine."""
    now = engine()
    return setting_properties(now.schema, [pattern.name for pattern in now.patterns])


class Carved(Stateless):
    """What makes a document object a carved one."""

    Type = TYPE

    def __init__(self, obj):
        obj.Proxy = self
        self._add_own_properties(obj)
        self._add_settings(obj)

    # --- FreeCAD calls these ---

    def execute(self, obj) -> None:
        """Brings the object up to date as far as that is quick."""
        if not obj.Source:
            raise BadInput(f"{obj.Label}: found no source, expected a body, a shape or a mesh")
        if obj.FollowSource and not same_placement(obj.Placement, obj.Source.Placement):
            obj.Placement = obj.Source.Placement
        self.refresh(obj)

    def onChanged(self, obj, name: str) -> None:
        if name == "ShowStress" and "StressColors" in obj.PropertiesList:
            self.show_colors(obj)

    def onDocumentRestored(self, obj) -> None:
        """Gives an object of an older version what it lacks."""
        self._add_own_properties(obj)
        migration.migrate(obj)
        if not obj.PatternColors:
            obj.PatternColors = obj.FaceColors
        try:
            self._add_settings(obj)
        except EngineError as missing:
            App.Console.PrintWarning(f"{obj.Label}: {missing}\n")

    # --- the workbench calls these ---

    def request(self, obj) -> CarveRequest:
        """What the engine is asked for. Raises EngineError."""
        model = model_of(obj.Source)
        return CarveRequest(
            model=model.data,
            model_format=model.format,
            model_name=obj.Label,
            model_fingerprint=model.fingerprint,
            values=changed_values(obj, properties_of_settings()),
            regions=tuple(self._regions(obj)),
            pictures=_pictures(obj),
        )

    def refresh(self, obj) -> None:
        """Shows what is known for the present settings, or makes a draft, or says that the result is out of date."""
        request = self.request(obj)
        key = request.key()
        known = remembered(key, draft=False) or remembered(key, draft=True)
        if obj.ResultKey == key:
            obj.State = CARVED if obj.PackageKey == key else DRAFT
        elif known:
            self.show(obj, known)
        elif failure(key, draft=True):
            self.show_failure(obj, failure(key, draft=True))
        elif obj.Update == BY_REQUEST:
            obj.State = OUTDATED if obj.ResultKey else NOT_CARVED
        elif App.GuiUp:
            # Qt is there with a window only.
            from . import background

            obj.State = OUTDATED if obj.ResultKey else NOT_CARVED
            background.start(obj, request, draft=True)
        else:
            self.show(obj, make(engine(), request, draft=True))

    def show(self, obj, result: Result) -> None:
        """Puts a result into the object."""
        mesh = read_mesh(result.mesh, obj.InputUp)
        mesh.Placement = obj.Placement
        obj.Mesh = mesh
        obj.PatternColors = read_face_colors(result.mesh)
        obj.StressColors, obj.Strength = [], []
        self.show_colors(obj)
        report = result.report
        obj.Summary = summary_lines(report)
        obj.Warnings = warning_lines(report)
        obj.SolidShare = round(100 * report["pattern"]["solid_fraction"])
        obj.Material = report["mesh"]["volume_mm3"]
        obj.Report = json.dumps(report)
        obj.ResultKey = result.key
        if result.package:
            obj.Package = str(result.package)
            obj.PackageKey = result.key
        obj.State = DRAFT if result.draft else CARVED

    def show_failure(self, obj, error: EngineError) -> None:
        """Says why there is no result for the present settings; what was made before stays."""
        obj.State = FAILED
        obj.Warnings = [str(error)]

    def show_strength(self, obj, strength: Strength) -> None:
        """Puts what the full analysis found into the object, unless another result is there by now."""
        if strength.key != obj.ResultKey:
            return
        obj.Strength = strength.lines
        obj.StressColors = strength.colors
        obj.ShowStress = bool(strength.colors)
        self.show_colors(obj)

    def show_colors(self, obj) -> None:
        """Those of the stress where they are wanted and there are any; else those of the pattern."""
        colors = obj.StressColors if obj.ShowStress and obj.StressColors else obj.PatternColors
        if obj.FaceColors != colors:
            obj.FaceColors = colors

    def _add_own_properties(self, obj) -> None:
        for kind, name, group, text, flags, first in _PROPERTIES:
            if name not in obj.PropertiesList:
                obj.addProperty(kind, name, group, text, flags)
                if first is not None:
                    setattr(obj, name, first)

    def _add_settings(self, obj) -> None:
        for entry in properties_of_settings():
            entry.add_to(obj)

    def _regions(self, obj) -> list[Region]:
        regions = []
        if obj.CarveFaces:
            regions.append(region_of(CARVE, obj.CarveFaces, obj.Source))
        if obj.KeepFaces:
            regions.append(region_of(KEEP, obj.KeepFaces, obj.Source))
        return regions


def _pictures(obj) -> dict[str, tuple[str, bytes]]:
    """The user's own pictures, as (name, bytes) by the key of the spec."""
    if obj.ExemplarPattern != OWN_PICTURE:
        return {}
    if not obj.ExemplarImage:
        raise BadSettings(f"{obj.Label}: found neither a pattern nor a picture, expected ExemplarPattern to name a "
                          "pattern or ExemplarImage to hold a picture")  # fmt: skip
    pictures = {}
    for entry in properties_of_settings():
        path = getattr(obj, entry.name) if entry.setting.key in PICTURES else ""
        if path:
            pictures[entry.setting.key] = (os.path.basename(path), Path(path).read_bytes())
    return pictures
