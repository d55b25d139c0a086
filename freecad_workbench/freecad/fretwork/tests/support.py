"""What tests of documents share: quick settings, a source, a document that goes away."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

import FreeCAD as App
import Part

from ..engine.errors import ProgramMissing
from ..preferences import engine

# A run of half a second.
QUICK = {
    "shell_resolution": 32,
    "synthesis_candidates": 8,
    "structure_samples": 100,
    "structure_max_iterations": 1,
    "exemplar_max_side_px": 64,
    "fabrication_simplify_voxels": 0.3,
}


def bored_box():
    """60 x 40 x 30 mm with a hole of radius 8 along z: Face1 and Face6 are its ends along x, Face7 is the bore."""
    return Part.makeBox(60, 40, 30).cut(Part.makeCylinder(8, 30, App.Vector(30, 20, 0)))


class DocumentTest(unittest.TestCase):
    """A test with a document and a folder of its own; skipped where there is no fretwork program."""

    def setUp(self):
        try:
            engine()
        except ProgramMissing as missing:
            self.skipTest(str(missing))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.document = App.newDocument("FretworkTest")
        self.addCleanup(lambda: App.closeDocument(self.document.Name))

    def shape(self, shape=None, name="Box"):
        """A shape in the document; the bored box unless another is given."""
        obj = self.document.addObject("Part::Feature", name)
        obj.Shape = shape or bored_box()
        return obj

    def reopened(self, name="file.FCStd"):
        """The document saved, closed and opened again."""
        path = str(self.folder / name)
        self.document.saveAs(path)
        App.closeDocument(self.document.Name)
        self.document = App.openDocument(path)
        return self.document
