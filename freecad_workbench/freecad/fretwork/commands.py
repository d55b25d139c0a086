"""The commands of the menu and the tool bar."""

from __future__ import annotations

import FreeCAD as App
import FreeCADGui as Gui

from .resources import icon
from .translation import noop, translate


def _resources(name: str, menu: str, tip: str) -> dict[str, str]:
    return {"Pixmap": icon(name), "MenuText": menu, "ToolTip": tip}


def _selected_carved() -> list:
    from .carved import is_carved

    return [obj for obj in Gui.Selection.getSelection() if is_carved(obj)]


def _name(obj) -> str:
    return f"App.getDocument({obj.Document.Name!r}).getObject({obj.Name!r})"


def _names(objects) -> str:
    return f"[{', '.join(map(_name, objects))}]"


def _run(*lines: str) -> None:
    """Runs Python, and shows it in the console and the report view."""
    for line in ("import freecad.fretwork as fw", *lines):
        App.Console.PrintMessage(line + "\n")
        Gui.doCommand(line)


def _try(line: str) -> None:
    """The same; what goes wrong is said in the report view."""
    try:
        _run(line)
    except Exception as error:
        App.Console.PrintError(f"{error}\n")


def _in_one_step(document, label: str, *lines: str, stays_open: bool = False) -> None:
    """The same as one step that can be undone; what stays open is closed by the panel that follows."""
    document.openTransaction(label)
    try:
        _run(*lines)
    except Exception as error:
        document.abortTransaction()
        App.Console.PrintError(f"{error}\n")
        return
    if not stays_open:
        document.commitTransaction()


class _OnCarved:
    """A command on selected carved objects."""

    def IsActive(self):
        return bool(_selected_carved())


class Carve:
    """Carves what is selected."""

    def GetResources(self):
        return _resources("Carve", noop("Fretwork_Carve", "Carve"),
                          noop("Fretwork_Carve", "Carve a pattern through the shell of the selected body or mesh; "
                               "faces that are selected too are the only ones carved"))  # fmt: skip

    def IsActive(self):
        return bool(Gui.Selection.getSelectionEx())

    def Activated(self):
        from .selection import picked_source

        picked = picked_source()
        if not picked:
            App.Console.PrintError(translate("Select a body, a shape or a mesh to carve") + "\n")
            return
        faces = f", faces={list(picked.faces)!r}" if picked.faces else ""
        document = picked.source.Document
        _in_one_step(document, translate("Carve"),
                     f"carved = fw.carve({_name(picked.source)}, pattern='cells'{faces}, draft=True, wait=False)",
                     f"Gui.getDocument({document.Name!r}).setEdit(carved.Name)", stays_open=True)  # fmt: skip


class Update(_OnCarved):
    """Carves the selected objects in full."""

    def GetResources(self):
        return _resources("Update", noop("Fretwork_Update", "Carve in full"),
                          noop("Fretwork_Update", "Make the whole result for the present settings, beside FreeCAD"))

    def Activated(self):
        for obj in _selected_carved():
            _in_one_step(obj.Document, translate("Carve in full"), f"fw.update({_name(obj)}, wait=False)")


class Stop:
    """Ends the runs of the selected objects."""

    def GetResources(self):
        return _resources("Stop", noop("Fretwork_Stop", "Stop"),
                          noop("Fretwork_Stop", "Stop the run of the selected object; it stays as it was"))

    def IsActive(self):
        from . import background

        return any(background.job_of(obj) for obj in _selected_carved())

    def Activated(self):
        for obj in _selected_carved():
            _run(f"fw.stop({_name(obj)})")


class CheckStrength(_OnCarved):
    """Analyses the selected objects."""

    def GetResources(self):
        return _resources("Strength", noop("Fretwork_Strength", "Check strength"),
                          noop("Fretwork_Strength", "Analyse the carved object voxel by voxel under its loads, and show "
                               "its stress in colours"))  # fmt: skip

    def Activated(self):
        for obj in _selected_carved():
            _try(f"fw.check_strength({_name(obj)}, wait=False)")


class Export(_OnCarved):
    """Writes the 3MF of the selected objects."""

    def GetResources(self):
        return _resources("Export", noop("Fretwork_Export", "Export 3MF..."),
                          noop("Fretwork_Export", "Write the carved objects as 3MF, with colours, voxel data and settings"))  # fmt: skip

    def Activated(self):
        from .qt import QtWidgets

        objects = _selected_carved()
        path, _ = QtWidgets.QFileDialog.getSaveFileName(
            Gui.getMainWindow(), translate("Export 3MF"), f"{objects[0].Label}.3mf", "3MF (*.3mf)"
        )
        if path:
            _try(f"fw.export({_names(objects)}, {path!r})")


class OpenInSlicer(_OnCarved):
    """Hands the selected objects to a slicer."""

    def GetResources(self):
        return _resources("Slicer", noop("Fretwork_Slicer", "Open in slicer"),
                          noop("Fretwork_Slicer", "Open the carved objects in PrusaSlicer, OrcaSlicer, Bambu Studio or "
                               "Cura"))  # fmt: skip

    def Activated(self):
        _try(f"fw.open_in_slicer({_names(_selected_carved())})")


COMMANDS = {
    "Fretwork_Carve": Carve,
    "Fretwork_Update": Update,
    "Fretwork_Stop": Stop,
    "Fretwork_Strength": CheckStrength,
    "Fretwork_Export": Export,
    "Fretwork_Slicer": OpenInSlicer,
}


def add_commands() -> list[str]:
    """Makes the commands known to FreeCAD and gives their names, in the order of the menu."""
    for name, command in COMMANDS.items():
        Gui.addCommand(name, command())
    return list(COMMANDS)
