#!/usr/bin/env bash
# On to G-code with PrusaSlicer, without repair.
. "$(dirname "$0")/common.sh"
needs prusa-slicer
awk -f models/vase.awk > "$OUT/vase.off"

"$FRETWORK" carve "$OUT/vase.off" --pattern ./vase.toml -D exemplar.pattern=bubbles --resolution "$RESOLUTION" -o "$OUT/11_slice.3mf"
prusa-slicer --export-gcode --support-material --layer-height 0.3 -o "$OUT/11_slice.gcode" "$OUT/11_slice.3mf" > "$OUT/11_slice.log"
