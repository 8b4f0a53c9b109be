"""Place and route one netlist: reads request.json, writes result.json and <cell>.gds into the working directory.

The exit status is 0 also where segments stayed open: result.json tells. Coriolis's own words go to the terminal.
"""

import json
import sys
import time
from pathlib import Path

from .session import configure, load


def main(request):
    request = json.loads(Path(request).read_text())
    begin = time.perf_counter()
    database = configure(request)
    from .block import make_block
    from .dump import instances, shapes, wires
    from .macros import make_macros
    from .short import draw_short

    make_macros(request)
    cell = load(request["cell"])
    block = make_block(cell, request, database)
    times = {"load": time.perf_counter() - begin}
    routed = block.doPnR()
    times.update(block.times)
    begin = time.perf_counter()
    print(f"short wires drawn: {draw_short(cell)}")
    block.save()
    Path("shapes.json").write_text(json.dumps(shapes(cell)))
    Path("result.json").write_text(
        json.dumps(
            {
                "routed": bool(routed),
                "straps": block.straps,
                "pins": block.pins,
                "instances": instances(cell),
                "wires": wires(cell),
                "times": times | {"save": time.perf_counter() - begin},
            }
        )
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
