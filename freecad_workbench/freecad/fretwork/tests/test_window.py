"""The workbench in FreeCAD's window; see tests/freecad/run_freecad_test.sh for how it gets one."""

from __future__ import annotations

import FreeCAD as App
import FreeCADGui as Gui

import freecad.fretwork as fw

from .. import background
from .support import QUICK
from .window import WindowTest, wait_until


class Commands(WindowTest):
    def test_selected_faces_become_a_carved_object_beside_its_source(self):
        box = self.shape()
        self.select(box, "Face6", "Face2")
        Gui.runCommand("Fretwork_Carve", 0)
        carved = self.document.Carved
        self.assertEqual(carved.State, "not carved")
        self.assertEqual(carved.CarveFaces, [(box, ("Face6", "Face2"))])
        wait_until(lambda: carved.State == "draft")
        self.assertFalse(box.ViewObject.Visibility)
        self.show()
        self.picture("carved-faces")
        self.document.undo()
        self.assertEqual([obj.Name for obj in self.document.Objects], ["Box"])
        self.assertTrue(box.ViewObject.Visibility)


class Runs(WindowTest):
    def carved(self):
        return fw.carve(self.shape(), pattern="hexagons", draft=True, **QUICK)

    def test_a_change_is_drafted_beside_the_window_and_the_last_one_wins(self):
        carved = self.carved()
        for seed in (2, 3, 4):
            carved.SynthesisSeed = seed
            self.document.recompute()
        self.assertEqual(carved.State, "out of date")
        job = background.job_of(carved)
        self.assertEqual(job.task.request.values["synthesis.seed"], 4)
        wait_until(lambda: carved.State == "draft")
        self.assertEqual(carved.ResultKey, job.task.key)
        self.assertTrue(carved.isValid())
        self.assertIsNone(background.job_of(carved))

    def test_colours_are_seen_after_a_run_and_after_reopening(self):
        carved = self.carved()
        self.show()
        for _ in range(2):
            wait_until(lambda: _shown_colors(carved) == carved.Mesh.CountFacets, 5)
            carved.ExemplarPattern = "waves"
            self.document.recompute()
            wait_until(lambda: carved.State == "draft" and not background.job_of(carved))
        carved = self.reopened().Carved
        wait_until(lambda: _shown_colors(carved) == carved.Mesh.CountFacets, 5)

    def test_stopping_leaves_the_object_as_it_was(self):
        carved = self.carved()
        triangles = carved.Mesh.CountFacets
        self.select(carved)
        carved.ShellResolution = 256
        Gui.runCommand("Fretwork_Update", 0)
        steps = []
        background.job_of(carved).progressed.connect(lambda stage, share: steps.append(share))
        wait_until(lambda: steps and steps[-1] > 0.05)
        self.show()
        self.picture("progress")
        Gui.runCommand("Fretwork_Stop", 0)
        wait_until(lambda: not background.job_of(carved), 5)
        self.assertEqual(carved.Mesh.CountFacets, triangles)

    def test_a_failure_is_told_and_the_window_goes_on(self):
        carved = self.carved()
        carved.ShellThickness = 0.01
        self.document.recompute()
        wait_until(lambda: carved.State == "failed")
        self.assertIn("use a thickness of", carved.Warnings[0])

    def test_an_object_that_is_deleted_meanwhile_takes_its_run_along(self):
        carved = self.carved()
        carved.SynthesisSeed = 7
        self.document.recompute()
        self.assertEqual(len(background.jobs()), 1)
        self.document.removeObject(carved.Name)
        wait_until(lambda: not background.jobs(), 5)
        self.assertEqual([obj.Name for obj in self.document.Objects], ["Box"])

    def test_a_document_that_is_closed_takes_its_runs_along(self):
        carved = self.carved()
        carved.ShellResolution = 256
        self.document.recompute()
        self.assertEqual(len(background.jobs()), 1)
        App.closeDocument(self.document.Name)
        self.document = App.newDocument("FretworkTest")
        wait_until(lambda: not background.jobs(), 5)

    def test_undo_after_a_late_result_shows_what_belongs_to_the_settings(self):
        self.document.UndoMode = 1
        carved = self.carved()
        first = carved.ResultKey
        self.document.openTransaction("change")
        carved.SynthesisSeed = 12
        self.document.commitTransaction()
        self.document.recompute()
        wait_until(lambda: carved.State == "draft")
        self.assertNotEqual(carved.ResultKey, first)
        self.document.undo()
        self.assertEqual(carved.SynthesisSeed, 1)
        wait_until(lambda: carved.ResultKey == first, 5)
        self.document.redo()
        wait_until(lambda: carved.ResultKey != first, 5)


def _shown_colors(obj) -> int:
    """How many colours the scene has for an object's triangles."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setType(coin.SoMaterial.getClassTypeId())
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    search.apply(obj.ViewObject.RootNode)
    paths = search.getPaths()
    return max(paths[i].getTail().diffuseColor.getNum() for i in range(paths.getLength()))
