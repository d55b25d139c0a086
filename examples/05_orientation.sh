#!/usr/bin/env bash
# Where the picture's up points on the surface: to the sky, along a vector, or wherever it fits best.
. "$(dirname "$0")/common.sh"
awk -f models/vase.awk > "$OUT/vase.off"

carve() {
  "$FRETWORK" carve "$OUT/vase.off" --pattern ./vase.toml -D exemplar.pattern=zebra -D "synthesis.orientation=$2" \
    --resolution "$RESOLUTION" -o "$OUT/$1.3mf"
}
carve 05_orientation_up up
carve 05_orientation_vector '[1, 0, 1]'
carve 05_orientation_free free
