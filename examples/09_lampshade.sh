#!/usr/bin/env bash
# A draft to look at within seconds, then the same arrangement in full.
. "$(dirname "$0")/common.sh"
awk -f models/lampshade.awk > "$OUT/lampshade.off"

"$FRETWORK" carve "$OUT/lampshade.off" --pattern ./09_lampshade.toml --preset draft --resolution $((RESOLUTION / 2)) \
  -o "$OUT/09_draft.ply" --preview "$OUT/09_draft.png"
"$FRETWORK" carve "$OUT/lampshade.off" --pattern ./09_lampshade.toml --resolution "$RESOLUTION" -o "$OUT/09_lampshade.3mf"
