"""The workbench. FreeCAD imports this when it starts, so nothing is loaded here that can wait."""

from __future__ import annotations

import FreeCADGui as Gui

from .resources import FOLDER, icon
from .translation import noop


class FretworkWorkbench(Gui.Workbench):
    """Carve a pattern, given by an example picture, through the shell of an object."""

    MenuText = noop("Workbench", "Fretwork")
    ToolTip = noop("Workbench", "Carve patterns through the shell of bodies and meshes, sound and printable")
    Icon = icon("Fretwork")

    def Initialize(self):
        from .commands import add_commands

        names = add_commands()
        self.appendToolbar("Fretwork", names)
        self.appendMenu("Fretwork", names)
        # The page's picture has to have this name.
        Gui.addIcon("preferences-fretwork", icon("Fretwork"))
        Gui.addPreferencePage(str(FOLDER / "preferences.ui"), "Fretwork")

    def GetClassName(self):
        return "Gui::PythonWorkbench"


Gui.addWorkbench(FretworkWorkbench())
