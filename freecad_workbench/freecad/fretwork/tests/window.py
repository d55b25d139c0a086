"""What tests in the window share: waiting with the window alive, pictures of it."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path
from typing import Callable

import FreeCADGui as Gui

from ..qt import QtCore, run
from .support import DocumentTest


def wait(seconds: float) -> None:
    """Lets the window live for a while."""
    loop = QtCore.QEventLoop()
    QtCore.QTimer.singleShot(int(1000 * seconds), loop.quit)
    run(loop)


def wait_until(condition: Callable[[], object], seconds: float = 60) -> None:
    """Lets the window live until the condition holds. Raises AssertionError after the time."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"still waiting after {seconds} s")
        wait(0.05)


class WindowTest(DocumentTest):
    """A test with a document in the window, in our workbench."""

    def setUp(self):
        super().setUp()
        Gui.activateWorkbench("FretworkWorkbench")

    def show(self, view: str = "axonometric") -> None:
        """The whole document from a fixed direction."""
        getattr(Gui.activeDocument().activeView(), f"view{view.capitalize()}")()
        Gui.SendMsgToActiveView("ViewFit")
        wait(0.3)

    def select(self, obj, *names: str) -> None:
        """Selects an object, or faces of it."""
        Gui.Selection.clearSelection()
        for name in names or ("",):
            Gui.Selection.addSelection(obj.Document.Name, obj.Name, name)

    def picture(self, name: str) -> None:
        """The whole window as it is, for people to look at; nothing where no folder for pictures is named."""
        folder = os.environ.get("FRETWORK_SCREENSHOTS")
        if folder:
            Path(folder).mkdir(parents=True, exist_ok=True)
            wait(0.2)
            subprocess.run(["import", "-window", "root", str(Path(folder) / f"{name}.png")], check=True)
