"""Runs a module of tests inside FreeCAD's window, once it is up, and ends FreeCAD with their verdict.

FRETWORK_TEST_MODULE names the module, FRETWORK_TEST_RESULT the file for the words of unittest.
"""

import os
import sys
import traceback
import unittest

import FreeCAD as App
from PySide import QtCore


def main() -> None:
    failed = True
    with open(os.environ["FRETWORK_TEST_RESULT"], "w", encoding="utf-8") as words:
        try:
            tests = unittest.defaultTestLoader.loadTestsFromName(os.environ["FRETWORK_TEST_MODULE"])
            failed = not unittest.TextTestRunner(stream=words, verbosity=2).run(tests).wasSuccessful()
        except BaseException:
            traceback.print_exc(file=words)
    # Open documents would ask whether to save them.
    for name in list(App.listDocuments()):
        App.closeDocument(name)
    sys.stdout.flush()
    QtCore.QCoreApplication.exit(1 if failed else 0)


QtCore.QTimer.singleShot(500, main)
