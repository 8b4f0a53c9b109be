#!/usr/bin/env bash
# Renew the locks (make locks): for Python 3.11 and later on every platform, versions and hashes of what runs (run), what
# video files add (video), searches (explore), tests and verification (test), cells and layouts (layout), `make lint`
# (lint), `make dist` (release); LibreLane has another environment; uv installs all of these (uv). pdk.lock is edited directly: one wheel whose
# dependencies are not wanted.
set -euo pipefail
cd "$(dirname "$0")"
compile() { uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header "$@"; }
lock() { compile ../pyproject.toml "$@"; }
lock --extra setup --output-file run.lock
lock --extra setup --extra video --constraint run.lock --output-file video.lock
lock --extra setup --extra explore --constraint run.lock --output-file explore.lock
lock --extra setup --extra test --extra verify --extra document --extra video --extra codecs --extra explore --constraint run.lock --output-file test.lock
lock --extra setup --extra layout --constraint test.lock --output-file layout.lock
compile --group ../pyproject.toml:lint --constraint layout.lock --output-file lint.lock
compile --group ../pyproject.toml:release --output-file release.lock
printf '%s\n' 'uv>=0.13,<0.14' | compile - --output-file uv.lock
printf '%s\n' librelane==3.0.17 pyosys==0.70 | compile - --output-file librelane.lock
