#!/usr/bin/env bash
# In a Makefile: made once, made again when the model or the set of parameters changes.
. "$(dirname "$0")/common.sh"
needs make

make -s -f 10_rules.mk FRETWORK="$FRETWORK" OUT="$OUT" RESOLUTION="$RESOLUTION"
