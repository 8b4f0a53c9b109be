"""`python -m flow.sizes`: cells, flip-flops and gate equivalents of every block, to build/sizes/."""

import argparse
import json
import subprocess
import sys
import tempfile
from dataclasses import asdict
from pathlib import Path

from base.files import insert, staged
from models.parameters import ParameterError

from .measure import ROOT, SizeError, measure
from .table import markdown, readme_table


def export(tops, options, folder):
    """Verilog of ``tops`` (all, if empty) in ``folder``, by rtl.export with ``options``. Raises SizeError."""
    command = [sys.executable, "-m", "rtl.export", "--out", folder, *(f"--top={t}" for t in tops), *options]
    result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if result.returncode:
        raise SizeError(result.stderr.strip().splitlines()[-1])
    return [Path(line) for line in result.stdout.splitlines()]


def main(argv=None):
    parser = argparse.ArgumentParser(
        prog="python -m flow.sizes",
        description=__doc__.splitlines()[0],
        epilog="Further options (--lanes, --rows, --divider ...) go to python -m rtl.export.",
    )
    parser.add_argument("tops", nargs="*", help="tops to measure; default: every one")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "sizes", help="folder of sizes.json and sizes.md")
    parser.add_argument("--document", type=Path, help="also put the blocks' table between the marks of this file")
    options, others = parser.parse_known_args(argv)
    try:
        with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
            sizes = [measure(path, path.stem) for path in export(options.tops, others, folder)]
        with staged(options.out) as part:
            (part / "sizes.json").write_text(json.dumps([asdict(s) for s in sizes], indent=1) + "\n")
            (part / "sizes.md").write_text(markdown(sizes))
        if options.document:
            insert(options.document, "sizes", readme_table(sizes))
    except (SizeError, ParameterError, OSError) as error:
        print(f"flow.sizes: {error}", file=sys.stderr)
        return 2
    print(markdown(sizes), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
