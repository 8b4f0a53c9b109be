"""A plugin of pytest (pyproject.toml): the proofs of a block are tests of it.

No part of conftest.py, on which every recorded trace depends.
"""

from pathlib import Path

import pytest


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect rtl/<block>/formal/proofs.yaml."""
    if file_path.name == "proofs.yaml" and file_path.parent.name == "formal":
        from talbot.verif.formal.items import ProofsFile  # where it is needed only

        return ProofsFile.from_parent(parent, path=file_path)
    return None
