#!/usr/bin/env bash
# The Python environment: venv.sh PYTHON FOLDER LOCK. Every package at the version and hash of the file LOCK.
set -euo pipefail
python=$1 folder=$2 lock=$3

fail() { echo "setup: $*" >&2; exit 2; }

fits() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 15))' 2>/dev/null; }
found() { "$1" -c 'import platform, sys; print("Python", platform.python_version(), "at", sys.executable)' 2>/dev/null \
    || echo nothing; }
given=$python
if [ "$python" = python3 ]; then # the default: this one, or another of the system's
    for python in python3 python3.14 python3.13 python3.12 python3.11; do
        ! fits "$python" || break
    done
fi
fits "$python" || fail "python = '$given': must be Python 3.11 to 3.14, is $(found "$given") (make PYTHON=/path/to/python3)"
command -v g++ >/dev/null || fail "g++ = not found: a C++ compiler is needed (Debian: apt-get install g++)"

if [ ! -x "$folder/bin/python" ]; then
    echo "setup: making $folder with $(found "$python")"
    # Debian splits ensurepip off Python; virtualenv brings a pip of its own.
    "$python" -m venv "$folder" 2>/dev/null || { rm -rf "$folder"; "$python" -m virtualenv -q "$folder"; } 2>/dev/null \
        || fail "venv = unavailable in '$python': install python3-venv (Debian: apt-get install python3-venv) or virtualenv"
fi

echo "setup: installing the packages of $lock"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes -r "$lock"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
echo "setup: ready, $(found "$folder/bin/python")"
