#!/usr/bin/env bash
# One OpenSCAD file with part, spec and marks; the program makes G-code of it in two commands.
. "$(dirname "$0")/common.sh"
needs openscad
needs prusa-slicer

"$FRETWORK" carve 12_marks.scad -D height=100 --resolution "$RESOLUTION" -o "$OUT/12_marks.3mf"
prusa-slicer --export-gcode --support-material --layer-height 0.3 -o "$OUT/12_marks.gcode" "$OUT/12_marks.3mf" > "$OUT/12_marks.log"
