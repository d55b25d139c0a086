"""The carved object in a document: `freecadcmd -t freecad.fretwork.tests.test_carved`."""

from __future__ import annotations

import hashlib
import importlib
import json
import subprocess
import time
import unittest.mock
from pathlib import Path

import FreeCAD as App
import Mesh
import Part

import freecad.fretwork as fw

from ..carved import is_carved
from ..engine.errors import BadInput, BadSettings, CannotBeMet, EngineError
from ..mesh_files import turn_of
from ..preferences import engine
from ..source import local_shape, model_of, same_placement
from .support import QUICK, DocumentTest, bored_box


def _area_on_plane(mesh, axis: int, at: float) -> float:
    """Area of the triangles that lie on a plane of the model."""
    return sum(f.Area for f in mesh.Facets if all(abs(point[axis] - at) < 0.02 for point in f.Points))


class CarveAndUpdate(DocumentTest):
    def test_a_draft_is_a_closed_coloured_mesh_in_the_place_of_its_source(self):
        box = self.shape()
        box.Placement = App.Placement(App.Vector(100, 0, 5), App.Rotation(30, 0, 0))
        carved = fw.carve(box, pattern="hexagons", draft=True, **QUICK)
        self.assertTrue(is_carved(carved))
        self.assertEqual(carved.State, "draft")
        self.assertTrue(carved.Mesh.isSolid())
        self.assertEqual(len(carved.FaceColors), carved.Mesh.CountFacets)
        self.assertTrue(same_placement(carved.Placement, box.Placement))
        for side in ("XMin", "XMax", "YMin", "YMax", "ZMin", "ZMax"):
            found, expected = (getattr(o.BoundBox, side) for o in (carved.Mesh, box.Shape))
            self.assertAlmostEqual(found, expected, delta=0.5, msg=side)
        self.assertLess(0, carved.Material.Value)
        self.assertLess(carved.Material.Value, 0.8 * box.Shape.Volume)

    def test_the_full_run_keeps_its_package_and_the_same_request_gives_the_same_bytes(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        self.assertEqual(carved.State, "carved")
        info = json.loads(engine().run(["info", carved.Package, "--json"]))
        self.assertEqual(info["mesh"]["triangles"], carved.Mesh.CountFacets)
        self.assertEqual(info["carved"]["spec"]["changed"]["exemplar"]["pattern"], "hexagons")
        self.assertEqual(info["objects"][0]["name"], "Box_carved")
        self.assertIn("1 piece", carved.Summary[0])

    def test_kept_faces_are_whole_and_carved_faces_are_the_only_ones_carved(self):
        box = self.shape()
        kept = fw.carve(box, pattern="hexagons", keep=["Face6"], draft=True, **QUICK)
        # The face is 40 x 30 mm; the pattern comes in over its border by at most a voxel.
        self.assertGreater(_area_on_plane(kept.Mesh, 0, 60.0), 0.93 * 1200)
        self.assertLess(_area_on_plane(kept.Mesh, 0, 0.0), 0.85 * 1200)
        only = fw.carve(box, pattern="hexagons", faces=["Face1"], draft=True, **QUICK)
        self.assertGreater(_area_on_plane(only.Mesh, 0, 60.0), 0.93 * 1200)
        self.assertLess(_area_on_plane(only.Mesh, 0, 0.0), 0.85 * 1200)

    def test_faces_have_the_numbers_that_freecad_shows(self):
        rounded = Part.makeBox(40, 30, 20)
        shapes = {
            "bored": bored_box(),
            "two solids": Part.makeCompound([Part.makeBox(30, 10, 10), Part.makeCone(9, 4, 12, App.Vector(50, 0, 0))]),
            "rounded": rounded.makeFillet(4, rounded.Edges[:5]),
            "turned": bored_box().copy().rotated(App.Vector(), App.Vector(1, 1, 0), 33),
        }
        for name, shape in shapes.items():
            obj = self.shape(shape, "S")
            shape, model = local_shape(obj), model_of(obj)
            path = self.folder / "s.brep"
            path.write_bytes(model.data)
            found = json.loads(engine().run(["info", str(path), "--json"]))["faces"]
            self.assertEqual(len(found), len(shape.Faces), name)
            for face in found:
                expected = shape.Faces[int(face["name"][4:]) - 1]
                self.assertAlmostEqual(face["area_mm2"] / expected.Area, 1, delta=0.01, msg=name)
                center = App.Vector(*face["center_mm"])
                self.assertLess(center.distanceToPoint(expected.CenterOfMass), 0.2, f"{name} {face['name']}")

    def test_moving_the_source_moves_the_result_and_carves_nothing(self):
        box = self.shape()
        carved = fw.carve(box, pattern="hexagons", draft=True, **QUICK)
        triangles, key = carved.Mesh.CountFacets, carved.ResultKey
        box.Placement = App.Placement(App.Vector(0, 0, 500), App.Rotation(0, 90, 0))
        self.document.recompute()
        self.assertEqual((carved.Mesh.CountFacets, carved.ResultKey), (triangles, key))
        self.assertAlmostEqual(carved.Mesh.BoundBox.ZMin, box.Shape.BoundBox.ZMin, delta=0.5)
        carved.FollowSource = False
        carved.Placement = App.Placement()
        self.document.recompute()
        self.assertAlmostEqual(carved.Mesh.BoundBox.ZMin, 0, delta=0.5)

    def test_a_recompute_drafts_what_changed_unless_it_is_to_wait(self):
        box = self.shape()
        carved = fw.carve(box, pattern="hexagons", **QUICK)
        full = carved.PackageKey
        carved.SynthesisSeed = 2
        self.document.recompute()
        self.assertEqual(carved.State, "draft")
        self.assertNotEqual(carved.ResultKey, full)
        carved.Update = "By request"
        carved.SynthesisSeed = 3
        self.document.recompute()
        self.assertEqual(carved.State, "out of date")
        # What has been made in this session is shown again at once, and in full.
        carved.SynthesisSeed = 1
        self.document.recompute()
        self.assertEqual((carved.State, carved.ResultKey), ("carved", full))
        box.Shape = Part.makeBox(20, 20, 40)
        fw.update(carved, draft=True)
        self.assertAlmostEqual(carved.Mesh.BoundBox.ZLength, 40, delta=0.5)

    def test_what_points_up_does_not_turn_the_result(self):
        box = self.shape(Part.makeBox(20, 25, 40))
        for up in ("x", "-x", "y", "-y", "z", "-z"):
            carved = fw.carve(box, pattern="dots", draft=True, input_up=up, **{**QUICK, "shell_resolution": 24})
            for length, found in zip((20, 25, 40), (carved.Mesh.BoundBox.XLength, carved.Mesh.BoundBox.YLength,
                                                    carved.Mesh.BoundBox.ZLength)):  # fmt: skip
                self.assertAlmostEqual(found, length, delta=1.0, msg=up)
            self.assertGreater(carved.Mesh.BoundBox.XMin, -1.0, up)
            self.assertGreater(carved.Mesh.BoundBox.ZMin, -1.0, up)
            sign = -1 if up[0] == "-" else 1
            axis = App.Vector(*(sign if name == up[-1] else 0 for name in "xyz"))
            self.assertLess(turn_of(up).multVec(axis).distanceToPoint(App.Vector(0, 0, 1)), 1e-12)


class Sources(DocumentTest):
    def test_a_mesh_with_the_triangles_of_its_segments(self):
        mesh = self.document.addObject("Mesh::Feature", "M")
        mesh.Mesh = _segmented(bored_box())
        mesh.Placement.Base = App.Vector(0, 0, 70)
        carved = fw.carve(mesh, pattern="hexagons", keep=["Segment6"], draft=True, **QUICK)
        self.assertGreater(_area_on_plane(carved.Mesh, 0, 60.0), 0.93 * 1200)
        self.assertLess(_area_on_plane(carved.Mesh, 0, 0.0), 0.85 * 1200)
        self.assertAlmostEqual(carved.Mesh.BoundBox.ZMin, 70, delta=0.5)

    def test_a_body_in_a_part_has_its_result_beside_it(self):
        part = self.document.addObject("App::Part", "Part")
        body = self.document.addObject("PartDesign::Body", "Body")
        part.addObject(body)
        pad = self.document.addObject("PartDesign::AdditiveBox", "Pad")
        pad.Length, pad.Width, pad.Height = 30, 20, 40
        body.addObject(pad)
        body.Placement.Base = App.Vector(0, 50, 0)
        self.document.recompute()
        carved = fw.carve(body, pattern="dots", draft=True, **QUICK)
        carved.KeepFaces = [(body, ("Pad.Face3",))]
        self.document.recompute()
        self.assertIn(carved, part.Group)
        self.assertNotIn(carved, body.Group)
        self.assertAlmostEqual(carved.Mesh.BoundBox.YMin, 50, delta=0.5)
        self.assertEqual(carved.Proxy.request(carved).regions[0].fields["names"], "Face3")
        self.assertTrue(carved.isValid())

    def test_a_link_stands_for_what_it_links_to(self):
        box = self.shape()
        link = self.document.addObject("App::Link", "Link")
        link.LinkedObject = box
        link.Placement.Base = App.Vector(0, 200, 0)
        self.document.recompute()
        carved = fw.carve(link, pattern="dots", keep=["Face7"], draft=True, **QUICK)
        self.assertAlmostEqual(carved.Mesh.BoundBox.YMin, 200, delta=0.5)

    def test_what_cannot_be_carved_is_named(self):
        with self.assertRaisesRegex(BadInput, "Line.*found no face"):
            fw.carve(self.shape(Part.makeLine((0, 0, 0), (1, 1, 1)), "Line"), pattern="cells")
        box, other = self.shape(), self.shape(name="Other")
        with self.assertRaisesRegex(BadInput, "Box has no Face9 any more, it has 7"):
            fw.carve(box, pattern="cells", keep=["Face9"])
        with self.assertRaisesRegex(BadInput, "Edge1, expected a face"):
            fw.carve(box, pattern="cells", keep=["Edge1"])
        carved = fw.carve(box, pattern="dots", draft=True, **QUICK)
        carved.KeepFaces = [(other, ("Face1",))]
        with self.assertRaisesRegex(BadInput, "Face1 of Other: found on another object, expected on Box"):
            carved.Proxy.request(carved)


class Documents(DocumentTest):
    def test_reopened_all_is_there_and_nothing_runs(self):
        picture = self.folder / "own.png"
        engine().run(["pattern", "show", "dots", "-o", str(picture)])
        box = self.shape()
        carved = fw.carve(box, image=str(picture), keep=["Face6"], shell_thickness_mm=4, **QUICK)
        picture.unlink()
        before = (carved.Mesh.CountFacets, carved.ResultKey, carved.Summary, carved.FaceColors[:5])
        with open(carved.Package, "rb") as file:
            package = file.read()
        carved = self.reopened().getObject("Carved")
        self.assertEqual((carved.Mesh.CountFacets, carved.ResultKey, carved.Summary, carved.FaceColors[:5]), before)
        self.assertEqual(carved.Proxy.request(carved).key(), carved.ResultKey)
        carved.touch()
        self.document.recompute()
        self.assertEqual(carved.State, "carved")
        with open(carved.Package, "rb") as file:
            self.assertEqual(file.read(), package)
        # Saved under another name, in another folder.
        (self.folder / "sub").mkdir()
        carved = self.reopened("sub/other.FCStd").getObject("Carved")
        self.assertEqual(carved.Proxy.request(carved).key(), carved.ResultKey)

    def test_undo_and_redo_bring_back_what_was_shown(self):
        self.document.UndoMode = 1
        box = self.shape()
        self.document.openTransaction("carve")
        carved = fw.carve(box, pattern="hexagons", draft=True, **QUICK)
        self.document.commitTransaction()
        first = carved.Mesh.CountFacets
        self.document.openTransaction("change")
        carved.ExemplarPattern = "waves"
        self.document.recompute()
        self.document.commitTransaction()
        second = carved.Mesh.CountFacets
        self.assertNotEqual(first, second)
        self.document.undo()
        self.assertEqual((carved.ExemplarPattern, carved.Mesh.CountFacets), ("hexagons", first))
        self.document.redo()
        self.assertEqual((carved.ExemplarPattern, carved.Mesh.CountFacets), ("waves", second))
        self.document.undo()
        self.document.undo()
        self.assertEqual([o.Name for o in self.document.Objects], ["Box"])

    def test_a_copy_goes_its_own_way(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        copy = self.document.copyObject(carved, False)
        self.assertTrue(is_carved(copy))
        self.assertEqual((copy.ResultKey, copy.Mesh.CountFacets), (carved.ResultKey, carved.Mesh.CountFacets))
        copy.SynthesisSeed = 9
        self.document.recompute()
        self.assertEqual((copy.State, carved.State), ("draft", "carved"))

    def test_without_the_program_a_document_opens_and_says_what_is_missing(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        path = str(self.folder / "file.FCStd")
        self.document.saveAs(path)
        script = self.folder / "opens.py"
        script.write_text(
            "import sys, FreeCAD\n"
            f"d = FreeCAD.openDocument({path!r})\n"
            f"c = d.getObject({carved.Name!r})\n"
            "print('shown', c.Mesh.CountFacets, c.State)\n"
            "c.touch(); d.recompute(); print('valid', c.isValid())\n"
            "sys.stdout.flush(); sys.exit(0)\n"
        )
        out = _freecad(script, FRETWORK="/nowhere/fretwork")
        self.assertIn(f"shown {carved.Mesh.CountFacets} carved", out)
        self.assertIn("valid False", out)
        self.assertIn("FRETWORK name '/nowhere/fretwork'", out)


class Mistakes(DocumentTest):
    def test_a_setting_that_is_none_is_named_with_the_nearest(self):
        with self.assertRaisesRegex(BadSettings, "'shell.thicknes_mm'; did you mean 'shell.thickness_mm'"):
            fw.carve(self.shape(), pattern="cells", shell_thicknes_mm=2)
        with self.assertRaisesRegex(BadSettings, "'nosuch': expected one of .*cells"):
            fw.carve(self.document.Box, pattern="nosuch")
        self.assertEqual([o.Name for o in self.document.Objects], ["Box"])

    def test_settings_that_contradict_each_other_say_what_would_work(self):
        with self.assertRaisesRegex(CannotBeMet, "use a thickness of"):
            fw.carve(self.shape(), pattern="cells", shell_thickness_mm=0.01)

    def test_neither_pattern_nor_picture(self):
        carved = fw.carve(self.shape(), pattern="dots", draft=True, **QUICK)
        carved.ExemplarPattern = "own picture"
        with self.assertRaisesRegex(BadSettings, "neither a pattern nor a picture"):
            fw.update(carved)


def _segmented(shape) -> Mesh.Mesh:
    """A mesh with a segment for each face."""
    import MeshPart

    return MeshPart.meshFromShape(Shape=shape, LinearDeflection=0.1, AngularDeflection=0.3, Segments=True)


def _freecad(script, **environment: str) -> str:
    """Output of a script in a FreeCAD of its own."""
    import os

    process = subprocess.run(["freecadcmd", str(script)], env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                             capture_output=True, text=True, timeout=60)  # fmt: skip
    return process.stdout + process.stderr


class Packages(DocumentTest):
    def test_only_a_full_result_of_the_present_settings_is_exported(self):
        carved = fw.carve(self.shape(), pattern="hexagons", draft=True, **QUICK)
        path = self.folder / "out.3mf"
        with self.assertRaisesRegex(BadSettings, "found no full result.*carve it in full"):
            fw.export([carved], str(path))
        fw.update(carved)
        self.assertEqual(fw.export([carved], str(path)), [str(path)])
        self.assertEqual(path.read_bytes(), Path(carved.Package).read_bytes())
        fw.change(carved, synthesis_seed=5)
        with self.assertRaisesRegex(BadSettings, "found an older result"):
            fw.export([carved], str(path))
        with self.assertRaisesRegex(BadInput, "Box: found Part::Feature"):
            fw.export([self.document.Box], str(path))

    def test_several_objects_go_into_files_of_their_own_or_none_does(self):
        one = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        two = fw.carve(self.document.Box, pattern="bricks", draft=True, **QUICK)
        two.Label = "lid/2"
        path = self.folder / "out.3mf"
        with self.assertRaises(BadSettings):
            fw.export([one, two], str(path))
        self.assertEqual(list(self.folder.iterdir()), [])
        fw.update(two)
        written = fw.export([one, two], str(path))
        self.assertEqual([Path(name).name for name in written], ["out-Box_carved.3mf", "out-lid_2.3mf"])
        for name in written:
            json.loads(engine().run(["info", name, "--json"]))

    def test_objects_of_one_label_do_not_write_over_each_other(self):
        one = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        two = fw.carve(self.document.Box, pattern="bricks", **QUICK)
        one.Label, two.Label = "lid a", "lid/a"  # one name as files
        written = fw.export([one, two], str(self.folder / "out.3mf"))
        self.assertEqual([Path(name).read_bytes() for name in written],
                         [Path(obj.Package).read_bytes() for obj in (one, two)])  # fmt: skip

    def test_a_file_is_written_whole_or_stays_as_it_was(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        path = self.folder / "out.3mf"
        path.write_bytes(b"before")
        with unittest.mock.patch("shutil.copyfileobj", side_effect=OSError(28, "No space left on device")):
            with self.assertRaisesRegex(BadInput, r"out\.3mf: cannot be written: No space left"):
                fw.export([carved], str(path))
        self.assertEqual(path.read_bytes(), b"before")
        self.assertEqual(list(self.folder.iterdir()), [path])
        with self.assertRaisesRegex(BadInput, "cannot be written: No such file"):
            fw.export([carved], str(self.folder / "none" / "out.3mf"))

    def test_freecad_exports_by_the_type_that_is_registered(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        self.assertIn("freecad.fretwork.exchange", App.getExportType("3mf"))
        path = self.folder / "out.3mf"
        importlib.import_module("freecad.fretwork.exchange").export([carved], str(path))
        self.assertEqual(path.read_bytes(), Path(carved.Package).read_bytes())

    def test_the_slicer_gets_the_package_under_the_name_of_the_object(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        told = self.folder / "told"
        slicer = self.folder / "slicer"
        slicer.write_text(f'#!/bin/sh\nsha256sum "$1" > "{told}.part" && mv "{told}.part" "{told}"\n')
        slicer.chmod(0o755)
        self.assertEqual(fw.open_in_slicer([carved], str(slicer)).name, "slicer")
        end = time.monotonic() + 20
        while not told.exists() and time.monotonic() < end:
            time.sleep(0.05)
        digest, name = told.read_text().split(maxsplit=1)
        self.assertEqual(digest, hashlib.sha256(Path(carved.Package).read_bytes()).hexdigest())
        self.assertEqual(Path(name.strip()).name, "Box_carved.3mf")
        with self.assertRaisesRegex(EngineError, "found no slicer 'nix'"):
            fw.open_in_slicer([carved], "nix")


class StrengthOfAResult(DocumentTest):
    def test_a_full_result_is_analysed_and_shown_in_the_colours_of_its_stress(self):
        carved = fw.carve(self.shape(), pattern="hexagons", draft=True, **QUICK)
        with self.assertRaisesRegex(BadSettings, "carve it in full"):
            fw.check_strength(carved)
        fw.update(carved)
        pattern = carved.FaceColors
        fw.check_strength(carved)
        found = json.loads(engine().run(["verify", carved.Package, "--json"]))["strength"]
        self.assertIn(f"factor of safety {found['factor_of_safety']:.3g}", carved.Strength[0])
        self.assertEqual(carved.Strength[0].startswith("holds"), found["holds"])
        self.assertEqual(len([line for line in carved.Strength if "moves by" in line]), len(found["cases"]))
        self.assertTrue(carved.ShowStress)
        self.assertEqual(len(carved.FaceColors), carved.Mesh.CountFacets)
        self.assertNotEqual(carved.FaceColors, pattern)
        carved.ShowStress = False
        self.assertEqual(carved.FaceColors, pattern)
        carved.ShowStress = True
        self.assertEqual(self.reopened().Carved.FaceColors, self.document.Carved.StressColors)
        # Another result has a strength of its own.
        carved = self.document.Carved
        fw.change(carved, synthesis_seed=5)
        fw.update(carved)
        self.assertEqual((carved.Strength, len(carved.StressColors)), ([], 0))
        self.assertEqual(carved.FaceColors, carved.PatternColors)
