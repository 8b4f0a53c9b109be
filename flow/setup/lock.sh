#!/usr/bin/env bash
# Renew the locks: one for Python 3.11 and later on every platform to run, one with what tests and verification
# add (needs uv: pip install uv).
set -euo pipefail
lock() { uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
    pyproject.toml "$@"; }
lock --extra setup --output-file requirements.lock
lock --all-extras --constraint requirements.lock --output-file requirements-test.lock
