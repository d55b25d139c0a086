"""The access to the program, without FreeCAD: `python3 -m unittest freecad.fretwork.tests.test_engine`.

What needs the program itself takes the one that the variable FRETWORK names, or that of the PATH.
"""

from __future__ import annotations

import os
import re
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

from ..engine.engine import Engine
from ..engine.errors import BadInput, BadSettings, Cancelled, CannotBeMet, EngineError, ProgramMissing, error_of
from ..engine.program import clean_environment, find_program
from ..engine.request import CarveRequest, lay_down
from ..engine.run import Messages
from ..engine.slicers import choose_slicer, find_slicers
from ..engine.spec import KEEP, LOADS, Region, spec_text

_TETRAHEDRON = b"OFF\n4 4 0\n0 0 0\n30 0 0\n0 30 0\n0 0 30\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"


def _request(**changes) -> CarveRequest:
    request = CarveRequest(_TETRAHEDRON, "off", "tip", "one", {"exemplar.pattern": "cells", "synthesis.seed": 3})
    return replace(request, **changes)


class AddonFiles(unittest.TestCase):
    WORKBENCH = Path(__file__).resolve().parents[3]

    def test_the_repository_and_its_workbench_folder_say_the_same_of_the_addon(self):
        above = self.WORKBENCH.parent / "package.xml"
        if not above.is_file():
            self.skipTest("the workbench is installed without the repository")
        inner = (self.WORKBENCH / "package.xml").read_text(encoding="utf-8")
        outer = above.read_text(encoding="utf-8")
        self.assertIn("<subdirectory>./freecad_workbench/</subdirectory>", outer)
        self.assertEqual(outer.replace("freecad_workbench/", ""), inner)
        project = (above.parent / "CMakeLists.txt").read_text(encoding="utf-8")
        version = re.search(r"project\(fretwork VERSION ([\d.]+)", project)
        self.assertIn(f"<version>{version[1]}</version>", inner)
        migration = (self.WORKBENCH / "freecad/fretwork/migration.py").read_text(encoding="utf-8")
        self.assertIn(f'VERSION = "{version[1]}"', migration)


class FindProgram(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name in ("first/fretwork", "second/fretwork"):
            program = self.folder / name
            program.parent.mkdir()
            program.write_text("#!/bin/sh\n")
            program.chmod(0o755)
        self.first, self.second = str(self.folder / "first/fretwork"), str(self.folder / "second/fretwork")

    def test_who_names_a_program_goes_before_who_does_not(self):
        path = {"PATH": str(self.folder / "second")}
        self.assertEqual(find_program("", path), self.second)
        self.assertEqual(find_program("", {**path, "FRETWORK": self.first}), self.first)
        self.assertEqual(find_program(self.second, {**path, "FRETWORK": self.first}), self.second)

    def test_a_name_that_is_no_program_is_an_error_and_not_passed_over(self):
        path = {"PATH": str(self.folder / "second")}
        plain = self.folder / "plain"
        plain.write_text("not to be run")
        for name in (str(plain), str(self.folder / "nothing")):
            with self.assertRaisesRegex(ProgramMissing, "the preferences name"):
                find_program(name, path)
            with self.assertRaisesRegex(ProgramMissing, "FRETWORK name"):
                find_program("", {**path, "FRETWORK": name})

    def test_without_any_the_error_says_where_one_may_be_named(self):
        with self.assertRaisesRegex(ProgramMissing, "install.*Preferences.*FRETWORK"):
            find_program("", {"PATH": str(self.folder)})

    def test_libraries_of_an_appimage_stay_with_freecad(self):
        surroundings = {"LD_LIBRARY_PATH": "/tmp/.mount/usr/lib", "HOME": "/home/u"}
        self.assertEqual(clean_environment(surroundings), surroundings)
        self.assertEqual(clean_environment({**surroundings, "APPIMAGE": "f"}), {"HOME": "/home/u", "APPIMAGE": "f"})


class ReadMessages(unittest.TestCase):
    TEXT = (
        b'{"stage": "voxelize", "fraction": 0.0100}\nfretwork: warning: a\n'
        b'{"stage": "write", "fraction": 1.0000}\nfretwork: error: b is 3 \xc3\xa4'
    )

    def test_pieces_of_any_size_say_the_same(self):
        for size in (1, 7, 41, len(self.TEXT)):
            steps = []
            messages = Messages(lambda stage, fraction: steps.append((stage, fraction)))
            for start in range(0, len(self.TEXT), size):
                messages.feed(self.TEXT[start : start + size])
            self.assertEqual(messages.lines, ["warning: a"])
            messages.finish()
            self.assertEqual(messages.lines, ["warning: a", "b is 3 ä"])
            self.assertEqual(steps, [("voxelize", 0.01), ("write", 1.0)])

    def test_each_exit_code_has_its_cause(self):
        causes = {1: BadSettings, 2: BadInput, 3: CannotBeMet, 130: Cancelled}
        for code, cause in causes.items():
            self.assertIs(type(error_of(code, "text")), cause)
            self.assertEqual(str(error_of(code, "text")), "text")
        self.assertIs(type(error_of(5, "")), EngineError)
        self.assertIn("code 5", str(error_of(5, "")))


class WriteSpecs(unittest.TestCase):
    def test_text_is_toml_and_does_not_depend_on_order(self):
        values = {"shell.thickness_mm": 2.5, "exemplar.pattern": 'a "b"', "shell.resolution": 64,
                  "structure.gravity": [0.0, 0.0, -1.0], "exemplar.invert": True}  # fmt: skip
        text = spec_text(values)
        self.assertEqual(text, spec_text(dict(reversed(values.items()))))
        self.assertEqual(
            text,
            '[exemplar]\ninvert = true\npattern = "a \\"b\\""\n'
            "[shell]\nresolution = 64\nthickness_mm = 2.5\n[structure]\ngravity = [0.0, 0.0, -1.0]\n",
        )

    def test_regions_follow_as_tables(self):
        text = spec_text({}, [Region.of_faces(LOADS, ["Face2", "Face4"], "push", force_n=(0, 0, -20)),
                              Region.of_triangles(KEEP, {5, 1})])  # fmt: skip
        self.assertEqual(
            text,
            '[[loads]]\nname = "push"\nshape = "named"\nnames = "Face2, Face4"\nforce_n = [0, 0, -20]\n'
            '[[keep]]\nshape = "triangles"\ntriangles = [1, 5]\n',
        )


class Requests(unittest.TestCase):
    def test_the_key_changes_with_all_that_the_result_depends_on_and_nothing_else(self):
        picture = {"exemplar.image": ("a.png", b"1")}
        others = [
            _request(model_fingerprint="two"),
            _request(model_format="ply"),
            _request(values={"exemplar.pattern": "cells"}),
            _request(regions=(Region.of_triangles(KEEP, [0]),)),
            _request(pictures=picture),
            _request(pictures={"exemplar.mask": picture["exemplar.image"]}),
            _request(pictures={"exemplar.image": ("a.png", b"2")}),
        ]
        keys = {_request().key(), *(other.key() for other in others)}
        self.assertEqual(len(keys), 1 + len(others))
        self.assertEqual(_request().key(), _request(model_name="other", model=b"the same, written otherwise").key())

    def test_names_that_are_no_file_names_become_some(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, expected in (("../a b/c", "a_b_c"), ("", "model"), ("Größe 2", "Größe_2"), ("..", "model")):
                files = lay_down(_request(model_name=name), Path(folder))
                self.assertEqual(files.model, Path(folder) / f"{expected}.off")

    def test_picture_and_mask_of_one_name_do_not_overwrite_each_other(self):
        pictures = {"exemplar.image": ("p.png", b"image"), "exemplar.mask": ("p.png", b"mask")}
        with tempfile.TemporaryDirectory() as folder:
            spec = lay_down(_request(pictures=pictures), Path(folder)).spec.read_text()
            for kind in ("image", "mask"):
                name = spec.split(f'{kind} = "')[1].split('"')[0]
                self.assertEqual((Path(folder) / name).read_bytes(), kind.encode())


class TheProgram(unittest.TestCase):
    def setUp(self):
        try:
            self.engine = Engine(find_program())
        except ProgramMissing as missing:
            self.skipTest(str(missing))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_schema_and_patterns_are_what_it_says_of_itself(self):
        thickness = self.engine.schema["shell.thickness_mm"]
        self.assertEqual((thickness.kind, thickness.unit, thickness.optional), ("number", "mm", True))
        self.assertTrue(thickness.open_minimum)
        self.assertEqual(self.engine.schema["synthesis.seed"].default, 1)
        self.assertIn("cells", [pattern.name for pattern in self.engine.patterns])
        self.assertRegex(self.engine.version, r"^\d+\.\d+\.\d+$")

    def test_causes_of_failure_arrive_with_their_words(self):
        files = lay_down(_request(values={"exemplar.pattern": "nosuch"}), self.folder)
        with self.assertRaisesRegex(BadSettings, "nosuch"):
            self.engine.run(files.draft_steps()[0])
        files = lay_down(_request(values={"exemplar.pattern": "cells", "shell.thickness_mm": 0.001}), self.folder)
        with self.assertRaisesRegex(CannotBeMet, "shell.thickness_mm"):
            self.engine.run(files.draft_steps()[0])
        files = lay_down(_request(model=b"OFF\n1"), self.folder)
        with self.assertRaisesRegex(BadInput, r"tip\.off"):
            self.engine.run(files.draft_steps()[0])

    def test_progress_rises_to_one(self):
        files = lay_down(_request(values={"exemplar.pattern": "dots", "shell.resolution": 24}), self.folder)
        steps = []
        self.engine.run(files.draft_steps()[0], lambda stage, fraction: steps.append(fraction))
        self.assertEqual(steps, sorted(steps))
        self.assertEqual(steps[-1], 1.0)
        self.assertTrue(files.mesh.is_file() and files.summary.is_file())

    def test_who_raises_in_between_stops_it_and_nothing_is_left_behind(self):
        files = lay_down(_request(), self.folder)

        def stop(_stage, fraction):
            if fraction > 0.05:
                raise Cancelled("enough")

        with self.assertRaisesRegex(Cancelled, "enough"):
            self.engine.run(files.full_steps()[0], stop)
        self.assertEqual(os.listdir(files.package.parent), [])


class Slicers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def program(self, name: str) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/sh\n")
        path.chmod(0o755)
        return path

    def found(self):
        return find_slicers({"PATH": str(self.folder)}, [self.folder / "flatpak"])

    def test_programs_and_flatpaks_are_found_one_of_each_kind(self):
        self.assertEqual(self.found(), [])
        cura, prusa = self.program("cura"), self.program("prusa-slicer")
        self.program("PrusaSlicer")
        orca = self.program("flatpak/com.orcaslicer.OrcaSlicer")
        self.assertEqual([(s.name, s.command) for s in self.found()],
                         [("PrusaSlicer", (str(prusa),)), ("OrcaSlicer", (str(orca),)), ("Cura", (str(cura),))])  # fmt: skip

    def test_one_is_chosen_by_name_or_as_a_program_and_else_the_first(self):
        self.program("cura"), self.program("prusa-slicer")
        own = self.program("own/slicer")
        self.assertEqual(choose_slicer("", self.found()).name, "PrusaSlicer")
        self.assertEqual(choose_slicer("cura", self.found()).name, "Cura")
        self.assertEqual(choose_slicer(str(own), self.found()).command, (str(own),))
        with self.assertRaisesRegex(LookupError, "'nix'.*there is PrusaSlicer, Cura"):
            choose_slicer("nix", self.found())
        with self.assertRaisesRegex(LookupError, "there is none"):
            choose_slicer("", [])


if __name__ == "__main__":
    unittest.main()
