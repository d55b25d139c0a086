#!/usr/bin/env bash
# Regions that stay solid are part of the spec.
. "$(dirname "$0")/common.sh"
awk -f models/bracket.awk > "$OUT/bracket.off"

"$FRETWORK" carve "$OUT/bracket.off" --pattern ./03_bracket.toml --resolution "$RESOLUTION" -o "$OUT/03_bracket.3mf"
