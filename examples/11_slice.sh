#!/usr/bin/env bash
# On to G-code with PrusaSlicer, without repair, and a look at whether anything went missing.
. "$(dirname "$0")/common.sh"
needs prusa-slicer
awk -f models/vase.awk > "$OUT/vase.off"

"$FRETWORK" carve "$OUT/vase.off" --pattern ./vase.toml -D exemplar.pattern=bubbles --resolution "$RESOLUTION" \
  -o "$OUT/11_slice.3mf" --slice profiles/fdm-0.4.ini --summary "$OUT/11_slice.json"
