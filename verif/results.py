"""What every step of `make verify` leaves behind: build/verify/<step>.json, a dict by block."""

import json

from base.files import staged
from base.paths import ROOT

OUT = ROOT / "build" / "verify"


def write_step(step, by_block, out=None):
    """Write the results of ``step`` (a dict by block that JSON can hold) into folder ``out``, or OUT."""
    with staged(out or OUT) as part:
        (part / f"{step}.json").write_text(json.dumps(by_block, indent=1, allow_nan=False) + "\n")
