"""Place one netlist, with clock tree and power straps.

Reads request.json, writes result.json and <cell>.gds into the working directory. Coriolis prints to
the terminal.
"""

import json
import sys
import time
from pathlib import Path

from .session import configure, load


def main(path: str) -> int:
    """Run the request in the file ``path``."""
    request = json.loads(Path(path).read_text(encoding="utf-8"))
    begin = time.perf_counter()
    configure(request)
    from .block import make_block
    from .dump import instances, masters, shapes
    from .macros import make_macros

    make_macros(request)
    cell = load(request["cell"])
    block = make_block(cell, request)
    times = {"load": time.perf_counter() - begin}
    block.doPnR()
    times.update(block.times)
    begin = time.perf_counter()
    block.save()
    result = {"straps": block.straps, "pins": block.pins, "instances": instances(cell)}
    result |= {"shapes": shapes(cell), "masters": masters(cell)}
    result |= {"times": times | {"save": time.perf_counter() - begin}}
    Path("result.json").write_text(json.dumps(result), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
