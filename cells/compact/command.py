"""The library Compact drawn, its files written and every cell checked: build/cells/compact/."""

import json
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.command import failures
from talbot.cells.compact.make import NoLayout
from talbot.cells.compact.write import written


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot cells-compact`."""
    parser.add_argument("--out", type=Path, default=Path("build/cells/compact"), help="folder of the library's files")
    parser.add_argument("--no-check", action="store_true", help="leave out DRC and LVS")


def run(options: Namespace) -> int:
    """Draw the library and print what its checks find; 1 where a cell has no layout or fails."""
    from talbot.cells.compact.check import check

    try:
        gds = written(options.out)
    except NoLayout as error:
        return failures([str(error)])
    names = list(json.loads(gds.with_name("areas.json").read_text(encoding="utf-8")))
    print(f"{len(names)} cells in {options.out}")
    if options.no_check:
        return 0
    bad = {name: verdict for name, verdict in check(options.out, names).items() if verdict.drc or not verdict.lvs}
    for name, verdict in bad.items():
        rules = ", ".join(f"{rule} x {count}" for rule, count in verdict.drc.items())
        print(f"  {name}: {rules or 'DRC clean'}; LVS {'matches' if verdict.lvs else 'does not match'}")
    print(f"DRC and LVS: {len(names) + 1 - len(bad)} of {len(names) + 1} clean")
    return 1 if bad else 0
