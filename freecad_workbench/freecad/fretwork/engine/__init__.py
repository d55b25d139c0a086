"""The fretwork program as Python sees it. Needs no FreeCAD and nothing beyond the standard library."""
