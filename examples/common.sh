# Shared by the numbered examples; sourced, not run. From the environment:
#   FRETWORK    the program (the one in PATH, else build/release/cli/fretwork)
#   OUT         folder for models and results (out/ beside README.md)
#   RESOLUTION  voxels along the longest side (256)
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
OUT=${OUT:-$repository/out}
RESOLUTION=${RESOLUTION:-256}
FRETWORK=${FRETWORK:-$(command -v fretwork || echo "$repository/build/release/cli/fretwork")}
mkdir -p "$OUT"
OUT=$(cd "$OUT" && pwd)
cd "$repository/examples"

# needs PROGRAM: ends the example with 77, which means skipped, where PROGRAM is not installed.
needs() {
  command -v "$1" > /dev/null && return
  echo "skipped: $1 is not installed" >&2
  exit 77
}
