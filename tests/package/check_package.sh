#!/usr/bin/env bash
# Makes the Debian package of a finished build, unpacks it and runs the program in it.
#   check_package.sh CPACK BUILD_FOLDER VERSION
set -euo pipefail
cpack=$1 build=$2 version=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

(cd "$build" && "$cpack" -G DEB -B "$work" > "$work/cpack.log" 2>&1) || { cat "$work/cpack.log"; exit 1; }
package=$(ls "$work"/fretwork_"$version"_*.deb)
dpkg-deb -x "$package" "$work/root"

found=$("$work/root/usr/bin/fretwork" --version)
[ "$found" = "$version" ] || [ "$found" = "fretwork $version" ] || { echo "the packaged program says '$found', expected $version"; exit 1; }
for library in libcholmod libtbb libembree libxml2 libzip libpng; do
  dpkg-deb -f "$package" Depends | grep -q "$library" || { echo "the package does not ask for $library"; exit 1; }
done
[ -s "$work/root/usr/share/doc/fretwork/LICENSE" ] || { echo "the package holds no licence"; exit 1; }
for file in package.xml LICENSE freecad/fretwork/init_gui.py freecad/fretwork/resources/icons/Fretwork.svg; do
  [ -s "$work/root/usr/share/freecad/Mod/Fretwork/$file" ] || { echo "the package lacks the FreeCAD workbench's $file"; exit 1; }
done
echo "package: $(basename "$package") holds fretwork $version"
