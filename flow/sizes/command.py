"""Cells, flip-flops and gate equivalents of every block, by synthesis: build/sizes/."""

import json
import tempfile
from argparse import ArgumentParser, Namespace
from dataclasses import asdict
from pathlib import Path

from talbot.base.command import Parser
from talbot.base.files import insert, marked, staged
from talbot.base.paths import RESULTS
from talbot.base.progress import each
from talbot.base.sensor import add_sensor
from talbot.flow.sizes.measure import measure
from talbot.flow.sizes.table import blocks_table, markdown
from talbot.rtl import export
from talbot.rtl.verilog import export_verilog


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot sizes`."""
    parser.add_argument("tops", nargs="*", help="tops to measure; default: every one")
    parser.add_argument("--out", type=Path, default=RESULTS / "sizes", help="folder of sizes.json and sizes.md")
    parser.add_argument("--document", type=Path, help="also put the blocks' table between the marks of this file")
    add_sensor(parser, export.FIELDS)


def run(options: Namespace) -> int:
    """Synthesize the tops, write and print their table."""
    if options.document:
        marked(options.document, "sizes")
    words = [
        f"--{name}={value}"
        for name in ("sensor", *export.FIELDS)
        if (value := getattr(options, name.replace("-", "_"))) is not None
    ]
    asked = Parser(prog="talbot sizes")
    export.add_arguments(asked)
    export.sensor_of(asked.parse_args([*(f"--top={top}" for top in options.tops), *words]))  # bad input: said here
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        tops = export_verilog(Path(folder), options.tops, words)
        sizes = [measure(path, path.stem) for path in each(tops, "top", lambda path: path.stem)]
    with staged(options.out) as part:
        (part / "sizes.json").write_text(
            json.dumps([asdict(size) for size in sizes], indent=1) + "\n", encoding="utf-8"
        )
        (part / "sizes.md").write_text(markdown(sizes), encoding="utf-8")
    if options.document:
        insert(options.document, "sizes", blocks_table(sizes))
    print(markdown(sizes), end="")
    print(f"{options.out}: sizes.json, sizes.md")
    return 0
