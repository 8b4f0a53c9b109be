#!/usr/bin/env bash
# Renew the locks: one for Python 3.11 and later on every platform to run, one with what tests and verification
# add, one with what cells and layouts add; one for LibreLane in an environment of its own (needs uv: pip install uv).
set -euo pipefail
compile() { uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header "$@"; }
lock() { compile pyproject.toml "$@"; }
lock --extra setup --output-file requirements/run.lock
lock --extra setup --extra test --extra verify --constraint requirements/run.lock --output-file requirements/test.lock
lock --extra setup --extra layout --constraint requirements/test.lock --output-file requirements/layout.lock
printf '%s\n' librelane==3.0.17 pyosys==0.70 | compile - --output-file requirements/librelane.lock
