#!/usr/bin/env bash
# Everything as in the paper: its candidates, labels, energies and order of reinforcement.
. "$(dirname "$0")/common.sh"
awk -f models/vase.awk > "$OUT/vase.off"

"$FRETWORK" carve "$OUT/vase.off" --pattern ./vase.toml -D exemplar.pattern=waves --preset paper \
  -D structure.rules=paper --resolution "$RESOLUTION" -o "$OUT/06_paper.3mf"
