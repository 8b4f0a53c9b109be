#!/usr/bin/env bash
# Renew requirements.lock: one lock for Python 3.11 and later on every platform (needs uv: pip install uv).
set -euo pipefail
uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-annotate --no-header \
    --all-extras pyproject.toml --output-file requirements.lock
