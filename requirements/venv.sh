#!/usr/bin/env bash
# The Python environment: venv.sh PYTHON FOLDER LOCK. Every package at the version and hash of the file LOCK.
set -euo pipefail
python=$1 folder=$2 lock=$3

fail() { echo "setup: $*" >&2; exit 2; }

"$python" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' 2>/dev/null \
    || fail "python = '$python': must be Python 3.11, 3.12 or 3.13 (make PYTHON=/path/to/python3)"
command -v g++ >/dev/null || fail "g++ = not found: a C++ compiler is needed (Debian: apt-get install g++)"

if [ ! -x "$folder/bin/python" ]; then
    echo "setup: making $folder"
    # Debian splits ensurepip off Python; virtualenv brings a pip of its own.
    "$python" -m venv "$folder" 2>/dev/null || { rm -rf "$folder"; "$python" -m virtualenv -q "$folder"; } 2>/dev/null \
        || fail "venv = unavailable in '$python': install python3-venv (Debian: apt-get install python3-venv) or virtualenv"
fi

echo "setup: installing the packages of $lock"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes -r "$lock"
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
echo "setup: ready"
