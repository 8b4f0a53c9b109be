"""What every step of `make verify` leaves behind: build/verify/<step>.json, a dict by block."""

import hashlib
import json

from base.files import staged
from base.paths import ROOT

OUT = ROOT / "build" / "verify"
SOURCES = ".py", ".rdl", ".sv", ".v", ".vlt", ".cpp", ".lib", ".yaml", ".json", ".html"


def write_step(step, by_block, out=None):
    """Write the results of ``step`` (a dict by block that JSON can hold) into folder ``out``, or OUT."""
    with staged(out or OUT) as part:
        (part / f"{step}.json").write_text(json.dumps(by_block, indent=1, allow_nan=False) + "\n")


def sources(*folders):
    """The files under these folders (or files) of the repository that decide a result, ascending: list of Path."""
    named = [ROOT / folder for folder in folders]
    found = {path for top in named for path in (top, *top.rglob("*")) if path.is_file()}
    return sorted(path for path in found if path in named or path.suffix in SOURCES and "__pycache__" not in path.parts)


def digest_of(*folders):
    """One digest of `sources` and of their names: text for ``Job.inputs``."""
    h = hashlib.sha256()
    for path in sources(*folders):
        h.update(str(path.relative_to(ROOT)).encode())
        h.update(path.read_bytes())
    return h.hexdigest()
