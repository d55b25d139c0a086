#!/usr/bin/env bash
# From a fresh Debian 12 machine to a carved bunny: packages, build, carve, picture, summary, page.
#   examples/bunny.sh [PATTERN [RESOLUTION]]
# The bunny is the 75,408-triangle one of Debian's libcgal-demo package; it is fetched as a package,
# unpacked beside the results, and never becomes part of this project.
set -euo pipefail
cd "$(dirname "$0")/.."
pattern=${1:-cells}
resolution=${2:-256}
out=out
mkdir -p "$out"

bash .ci/install_packages
command -v ccache > /dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --preset release -DFRETWORK_TESTS=OFF > "$out/configure.log"
cmake --build --preset release --target fretwork

if [ ! -s "$out/bunny00.off" ]; then
  fetched=$(mktemp -d)
  trap 'rm -rf "$fetched"' EXIT
  chmod 755 "$fetched"
  (cd "$fetched" && apt-get download -qq libcgal-demo 2> /dev/null)
  dpkg-deb --fsys-tarfile "$fetched"/libcgal-demo_*.deb |
    tar -xO ./usr/share/doc/libcgal-dev/data.tar.gz | tar -xzO data/meshes/bunny00.off > "$fetched/bunny00.off"
  mv "$fetched/bunny00.off" "$out/bunny00.off"
fi

build/release/cli/fretwork carve "$out/bunny00.off" --up y --size-mm 100 --pattern "$pattern" --set "shell.resolution=$resolution" \
  -o "$out/bunny-$pattern.3mf" --summary "$out/bunny-$pattern.json" --preview "$out/bunny-$pattern.png" \
  --report "$out/bunny-$pattern.html"
ls -l "$out"/bunny-"$pattern".*
