#!/usr/bin/env bash
# A drop, grips and worst cases besides the weight; the full analysis judges the carved file by the same cases.
. "$(dirname "$0")/common.sh"
awk -f models/vase.awk > "$OUT/vase.off"

"$FRETWORK" carve "$OUT/vase.off" --pattern ./13_rough_use.toml --resolution "$RESOLUTION" \
  -o "$OUT/13_rough_use.3mf" --summary "$OUT/13_rough_use.json"
"$FRETWORK" verify "$OUT/13_rough_use.3mf" --json > "$OUT/13_strength.json"
