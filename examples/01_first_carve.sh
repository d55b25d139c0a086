#!/usr/bin/env bash
# A model and the name of a pattern in, a carved model out.
. "$(dirname "$0")/common.sh"
awk -f models/egg.awk > "$OUT/egg.off"

"$FRETWORK" carve "$OUT/egg.off" --pattern cells --resolution "$RESOLUTION" -o "$OUT/01_first_carve.3mf"
