"""The workbench in FreeCAD's window; see tests/freecad/run_freecad_test.sh for how it gets one."""

from __future__ import annotations

import unittest.mock
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui

import freecad.fretwork as fw

from .. import background
from ..preferences import parameters
from ..qt import QtCore, QtWidgets
from .support import QUICK
from .window import WindowTest, wait, wait_until


class Panel(WindowTest):
    def setUp(self):
        super().setUp()
        dock = Gui.getMainWindow().findChild(QtWidgets.QDockWidget, "Combo View")
        if dock:
            dock.show()
            Gui.getMainWindow().resizeDocks([dock], [430], QtCore.Qt.Horizontal)
        self.box = self.shape()

    def tearDown(self):
        Gui.Control.closeDialog()

    def open(self, *faces: str):
        """The panel of a new carved object."""
        self.select(self.box, *faces)
        Gui.runCommand("Fretwork_Carve", 0)
        carved = self.document.Carved
        fw.change(carved, **QUICK)
        carved.recompute()
        wait_until(lambda: carved.State == "draft")
        return carved

    def widget(self, name: str):
        found = Gui.getMainWindow().findChild(QtWidgets.QWidget, name)
        self.assertIsNotNone(found, name)
        return found

    def press(self, button) -> None:
        """A standard button of the task panel."""
        boxes = [box for box in Gui.getMainWindow().findChildren(QtWidgets.QDialogButtonBox)
                 if box.button(button) and not box.isHidden()]  # fmt: skip
        self.assertEqual(len(boxes), 1)
        boxes[0].button(button).click()
        wait(0.1)

    def test_selected_faces_become_a_carved_object_and_cancel_takes_it_back(self):
        carved = self.open("Face6", "Face2")
        self.assertEqual(carved.CarveFaces, [(self.box, ("Face6", "Face2"))])
        self.assertFalse(self.box.ViewObject.Visibility)
        self.show()
        self.picture("panel")
        self.press(QtWidgets.QDialogButtonBox.Cancel)
        self.assertEqual([obj.Name for obj in self.document.Objects], ["Box"])
        self.assertTrue(self.box.ViewObject.Visibility)
        self.assertFalse(Gui.Control.activeDialog())

    def test_a_change_in_the_panel_is_drafted_and_ok_makes_it_one_step_of_undo(self):
        carved = self.open()
        first = carved.ResultKey
        patterns = self.widget("FretworkPatterns")
        waves = patterns.findItems("waves", QtCore.Qt.MatchExactly)[0]
        patterns.setCurrentItem(waves)
        wait_until(lambda: carved.ResultKey != first and carved.State == "draft")
        self.assertEqual(carved.ExemplarPattern, "waves")
        wall = self.widget("FretworkShellThickness")
        wall.setProperty("rawValue", 5.0)
        wait_until(lambda: carved.Proxy.request(carved).key() == carved.ResultKey)
        self.assertEqual(carved.ShellThickness.Value, 5.0)
        self.assertIn("wall 5", self.widget("FretworkSummary").text())
        self.press(QtWidgets.QDialogButtonBox.Ok)
        self.assertEqual(carved.State, "draft")
        self.document.undo()
        self.assertEqual([obj.Name for obj in self.document.Objects], ["Box"])
        self.document.redo()
        self.assertEqual(self.document.Carved.ExemplarPattern, "waves")

    def test_faces_are_picked_in_the_view(self):
        carved = self.open()
        self.widget("FretworkKeepFaces").click()
        self.assertTrue(self.box.ViewObject.Visibility)
        self.assertFalse(carved.ViewObject.Visibility)
        for face in ("Face3", "Face6", "Face2", "Face6"):
            Gui.Selection.addSelection(self.document.Name, self.box.Name, face)
            wait(0.05)
        self.show()
        self.picture("picking")
        self.assertEqual(carved.KeepFaces, [(self.box, ("Face3", "Face2"))])
        self.widget("FretworkKeepFaces").click()
        self.assertFalse(self.box.ViewObject.Visibility)
        self.assertTrue(carved.ViewObject.Visibility)
        self.press(QtWidgets.QDialogButtonBox.Ok)

    def test_run_and_stop_in_the_panel(self):
        carved = self.open()
        self.widget("FretworkRun").click()
        wait_until(lambda: carved.State == "carved")
        wait(0.1)
        self.assertIn("carved", self.widget("FretworkSummary").text())
        self.assertFalse(self.widget("FretworkStop").isEnabled())
        carved.ShellResolution = 256
        self.widget("FretworkRun").click()
        self.assertTrue(self.widget("FretworkStop").isEnabled())
        wait(0.3)
        self.widget("FretworkStop").click()
        wait_until(lambda: not background.jobs())
        self.assertEqual(carved.Proxy.request(carved).values["shell.resolution"], 256)
        self.press(QtWidgets.QDialogButtonBox.Cancel)

    def test_a_mistake_is_told_in_the_panel(self):
        carved = self.open()
        self.widget("FretworkShellThickness").setProperty("rawValue", 0.01)
        wait_until(lambda: "use a thickness of" in self.widget("FretworkSummary").text())
        self.picture("mistake")
        self.assertEqual(carved.State, "failed")
        # Nobody tries again what failed, and what would work is made.
        carved.Proxy.refresh(carved)
        self.assertEqual((carved.State, background.jobs()), ("failed", []))
        carved.ShellThickness = 5.0
        carved.Proxy.refresh(carved)
        wait_until(lambda: carved.State == "draft")
        self.press(QtWidgets.QDialogButtonBox.Cancel)

    def test_an_object_that_is_deleted_under_its_panel_disturbs_nobody(self):
        self.open()
        self.document.removeObject("Carved")
        other = fw.carve(self.box, pattern="waves", draft=True, **QUICK)
        self.assertEqual(other.State, "draft")

    def test_edit_again_and_cancel_brings_back_what_was(self):
        carved = self.open()
        self.press(QtWidgets.QDialogButtonBox.Ok)
        before = carved.ResultKey
        Gui.ActiveDocument.setEdit(carved.Name)
        self.widget("FretworkSynthesisScale").setProperty("rawValue", 2.0)
        wait_until(lambda: carved.ResultKey != before)
        self.press(QtWidgets.QDialogButtonBox.Cancel)
        self.assertEqual(carved.SynthesisScale, 1.0)
        wait_until(lambda: carved.ResultKey == before and carved.State == "draft")


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
            wait_until(lambda: _shown_colors(carved) == carved.Mesh.CountFacets)
            carved.ExemplarPattern = "waves"
            self.document.recompute()
            wait_until(lambda: carved.State == "draft" and not background.job_of(carved))
        carved = self.reopened().Carved
        wait_until(lambda: _shown_colors(carved) == carved.Mesh.CountFacets)

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
        wait_until(lambda: not background.job_of(carved))
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
        wait_until(lambda: not background.jobs())
        self.assertEqual([obj.Name for obj in self.document.Objects], ["Box"])

    def test_a_document_that_is_closed_takes_its_runs_along(self):
        carved = self.carved()
        carved.ShellResolution = 256
        self.document.recompute()
        self.assertEqual(len(background.jobs()), 1)
        App.closeDocument(self.document.Name)
        self.document = App.newDocument("FretworkTest")
        wait_until(lambda: not background.jobs())

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
        wait_until(lambda: carved.ResultKey == first)
        self.document.redo()
        wait_until(lambda: carved.ResultKey != first)


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


class Preferences(WindowTest):
    def test_the_page_keeps_the_slicer_that_is_named(self):
        self.addCleanup(parameters().RemString, "Slicer")
        seen = []

        def name_a_slicer():
            dialog = QtWidgets.QApplication.activeModalWidget()
            chooser = dialog.findChild(QtWidgets.QWidget, "slicer")
            seen.append(chooser is not None)
            self.picture("preferences")
            if chooser:
                chooser.setProperty("fileName", "/opt/slicer")
            dialog.accept()

        QtCore.QTimer.singleShot(500, name_a_slicer)
        Gui.showPreferences("Fretwork", 0)
        self.assertEqual(seen, [True])
        self.assertEqual(parameters().GetString("Slicer"), "/opt/slicer")


class Exchange(WindowTest):
    def test_a_carved_object_is_exported_by_its_command(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        path = self.folder / "box.3mf"
        self.select(carved)
        with unittest.mock.patch.object(QtWidgets.QFileDialog, "getSaveFileName", return_value=(str(path), "")):
            Gui.runCommand("Fretwork_Export", 0)
        self.assertEqual(path.read_bytes(), Path(carved.Package).read_bytes())

    def test_strength_is_checked_beside_the_window(self):
        carved = fw.carve(self.shape(), pattern="hexagons", **QUICK)
        self.select(carved)
        Gui.runCommand("Fretwork_Strength", 0)
        self.assertEqual(len(background.jobs()), 1)
        wait_until(lambda: carved.ShowStress and not background.jobs())
        self.assertIn("factor of safety", carved.Strength[0])
        self.assertEqual(carved.State, "carved")
        Gui.Selection.clearSelection()
        self.show()
        self.picture("strength")
