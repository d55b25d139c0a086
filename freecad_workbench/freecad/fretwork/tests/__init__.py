"""Tests of the workbench, for FreeCAD's own test framework: `freecadcmd -t freecad.fretwork.tests.test_app`."""
