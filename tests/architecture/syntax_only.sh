#!/bin/sh
# A compiler's launcher for what is only to be looked at: nothing is generated, the object is an empty file.
"$@" -fsyntax-only || exit
while [ "$1" != -o ]; do shift; done
: > "$2"
