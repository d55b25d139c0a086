#!/usr/bin/env bash
# Loads and fixtures of an intended use; the summary says how large the stress is, and --strict would insist on it.
. "$(dirname "$0")/common.sh"
awk -f models/bracket.awk > "$OUT/bracket.off"

"$FRETWORK" carve "$OUT/bracket.off" --pattern ./04_loads.toml --resolution "$RESOLUTION" \
  -o "$OUT/04_loads.3mf" --summary "$OUT/04_loads.json"
