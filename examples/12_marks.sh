#!/usr/bin/env bash
# One OpenSCAD file with part, spec and marks; one command makes G-code of it.
. "$(dirname "$0")/common.sh"
needs openscad
needs prusa-slicer

"$FRETWORK" carve 12_marks.scad -D height=100 --resolution "$RESOLUTION" -o "$OUT/12_marks.3mf" --slice profiles/fdm-0.4.ini
