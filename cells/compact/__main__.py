"""python -m cells.compact: draw the library, write its files and check every cell."""

import argparse
import json
import sys
from pathlib import Path

from base.files import check_folder
from base.tools import ToolError
from cells.compact.make import NoLayout
from cells.compact.write import written
from models.parameters import ParameterError


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python -m cells.compact", description=__doc__)
    parser.add_argument("--out", default="build/cells/compact", help="folder of the library's files")
    parser.add_argument("--no-check", action="store_true", help="leave out DRC and LVS")
    options = parser.parse_args(arguments)
    try:
        check_folder("out", options.out)
        return _run(Path(options.out), not options.no_check)
    except NoLayout as error:
        print(f"compact: {error}", file=sys.stderr)
        return 1
    except (ParameterError, ToolError) as error:
        print(f"compact: {error}", file=sys.stderr)
        return 2


def _run(out, checked):
    from cells.compact.check import check

    gds = written(out)
    names = list(json.loads(gds.with_name("areas.json").read_text()))
    print(f"{len(names)} cells in {out}")
    if not checked:
        return 0
    result = check(out, names)
    bad = {name: found for name, found in result.items() if found["drc"] or not found["lvs"]}
    for name, found in bad.items():
        rules = ", ".join(f"{rule} x {count}" for rule, count in found["drc"].items())
        print(f"  {name}: {rules or 'DRC clean'}; LVS {'matches' if found['lvs'] else 'does not match'}")
    print(f"DRC and LVS: {len(names) + 1 - len(bad)} of {len(names) + 1} clean")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
