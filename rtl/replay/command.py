"""Record a block's ports during its tests; replay the trace into any Verilog of the block."""

import argparse
import sys
from pathlib import Path

from talbot.base.command import main
from talbot.models.parameters import ParameterError
from talbot.rtl.replay.record import record
from talbot.rtl.replay.replay import replay_files
from talbot.rtl.replay.trace import load
from talbot.rtl.tops import TEST_CHIP_1, TOPS


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `talbot replay`."""
    commands = parser.add_subparsers(dest="action", required=True)
    recording = commands.add_parser("record", help="run a block's tests and save a trace a parameter set")
    recording.add_argument("block", choices=(*TOPS, *TEST_CHIP_1))
    recording.add_argument("--out", type=Path, required=True, help="folder of the traces")
    replaying = commands.add_parser("replay", help="compare Verilog with traces; status 1 where they differ")
    replaying.add_argument("trace", type=Path, nargs="+", help=".json files of one parameter set")
    replaying.add_argument("--verilog", type=Path, nargs="+", required=True, help="files with the module")
    replaying.add_argument("--cells", type=Path, nargs="+", default=[], help="models of a netlist's cells")
    replaying.add_argument("--top", help="its name (the traced class's)")
    replaying.add_argument("--strict", action="store_true", help="a msg counts where its val is 0, too")


def run(options: argparse.Namespace) -> int:
    """Record or replay; returns 1 if the Verilog differs from a trace."""
    if options.action == "record":
        for path in record(options.block, options.out):
            head = load(path, cycles=False)
            print(f"{path}: {head.cls}{head.arguments or '()'}: {head.cycles} cycles")
        return 0
    for path in (*options.trace, *options.verilog, *options.cells):
        if not path.is_file():
            raise ParameterError(f"file = {path}: no such file")
    mismatches = replay_files(options.trace, options.verilog, options.top, options.cells, options.strict)
    for mismatch in mismatches:
        print(mismatch)
    return 1 if mismatches else 0


if __name__ == "__main__":
    sys.exit(main(sys.modules[__name__]))
