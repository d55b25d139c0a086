#!/usr/bin/env bash
# Runs a module of the workbench's tests, with a fresh profile of FreeCAD.
#   run_freecad_test.sh WORKBENCH MODULE           in freecadcmd
#   run_freecad_test.sh WORKBENCH MODULE --window  in FreeCAD's window, without a screen
#   run_freecad_test.sh WORKBENCH MODULE --plain   in Python without FreeCAD
# The variable FRETWORK names the program, FRETWORK_SCREENSHOTS a folder for pictures.
# Exit code 77: what it takes is not here.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
workbench=$1 module=freecad.fretwork.tests.$2 how=${3:-}
export PYTHONDONTWRITEBYTECODE=1

needed() { command -v "$@" | head -n 1 | grep . || { echo "skipped: there is no $1" >&2; exit 77; }; }

if [ "$how" = --plain ]; then
  # -S: a package `freecad` that is installed would hide that of the workbench.
  PYTHONPATH=$workbench exec /usr/bin/python3 -S -m unittest "$module"
fi

home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
export FREECAD_USER_HOME=$home
mkdir "$home/Mod"
ln -s "$workbench" "$home/Mod/Fretwork"

if [ "$how" = --window ]; then
  program=$(needed freecad FreeCAD)
  needed xvfb-run > /dev/null
  cp "$here/user.cfg" "$home/user.cfg"
  export FRETWORK_TEST_MODULE=$module FRETWORK_TEST_RESULT=$home/result XDG_RUNTIME_DIR=$home
  xvfb-run -a -s "-screen 0 1400x1000x24" "$program" -u "$home/user.cfg" --log-file "$home/freecad.log" "$here/in_window.py" \
    > "$home/log" 2>&1 < /dev/null || echo "FreeCAD ended with code $?"
  # FreeCAD's exit code says little: what counts is the last word of unittest.
  [ -s "$home/result" ] && cat "$home/result"
  tail -n 1 "$home/result" | grep -q '^OK' && exit 0
  tail -n 60 "$home/log" "$home/freecad.log"
  exit 1
fi
program=$(needed freecadcmd FreeCADCmd)
"$program" -t "$module" < /dev/null
