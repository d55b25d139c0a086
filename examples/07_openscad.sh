#!/usr/bin/env bash
# A step of an OpenSCAD build: the model comes through a pipe.
. "$(dirname "$0")/common.sh"
needs openscad

openscad -q -o - --export-format off 07_openscad.scad |
  "$FRETWORK" carve - --input-format off --pattern celtic --resolution "$RESOLUTION" -o "$OUT/07_openscad.3mf"
