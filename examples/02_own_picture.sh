#!/usr/bin/env bash
# Any picture is a pattern: dark stays, light is cut out, and --width-mm says how wide the picture is on the surface.
. "$(dirname "$0")/common.sh"
awk -f models/vase.awk > "$OUT/vase.off"

"$FRETWORK" carve "$OUT/vase.off" --pattern ./vase.toml --exemplar 02_leaves.png --width-mm 90 \
  --resolution "$RESOLUTION" -o "$OUT/02_own_picture.3mf"
