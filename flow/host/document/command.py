"""Write the documents for a host: docs/registers.*, the tables of host.md, the C header.

build/registers/ has the map for other tools: a page, IP-XACT and a C header of structs (PeakRDL).
"""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.files import check_file, check_folder, insert, write
from talbot.base.paths import RESULTS, ROOT
from talbot.models.parameters import ParameterError
from talbot.models.parameters.registers import register_map

from . import exports, registers, tables
from .c_header import c_header

DOCUMENT = "host.md"
HEADER = Path(__file__).parents[1] / "asp_chip_registers.h"


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot document`."""
    parser.add_argument("--out", type=Path, default=ROOT / "docs", help=f"folder of {DOCUMENT}")
    parser.add_argument("--header", type=Path, default=HEADER, help="the C header")
    parser.add_argument("--exports", type=Path, default=RESULTS / "registers", help="folder of the map for other tools")


def run(options: Namespace) -> int:
    """Write every file. Raises ParameterError before the first."""
    check_file("header", options.header)
    check_folder("exports", options.exports)
    if not (options.out / DOCUMENT).is_file():
        raise ParameterError(f"out = {str(options.out)!r}: must be a folder with {DOCUMENT}")
    chip = register_map()
    maps = {"registers.md": registers.markdown(chip), "registers.html": registers.html(chip)}
    for name, text in maps.items():
        write(options.out / name, text)
    write(options.header, c_header(chip))
    exports.export(options.exports)
    for mark, table in tables.TABLES.items():
        insert(options.out / DOCUMENT, mark, table())
    print(f"{len(chip.fields)} fields of registers, {len(tables.TABLES)} tables of {DOCUMENT}")
    print(f"  {options.out}: {', '.join((*maps, DOCUMENT))}")
    print(f"  {options.header}")
    print(f"  {options.exports}: {', '.join((exports.PAGE, exports.IPXACT, exports.HEADER))}")
    print(f"  look at {options.exports / exports.PAGE}")
    return 0
