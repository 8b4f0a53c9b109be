"""Write the documents for a host: docs/registers.*, the tables of host.md, chip.md and stream.md, the C header.

For other tools, by PeakRDL: build/registers/ with a site (html/index.html), IP-XACT and a C header of structs.
"""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.files import check_file, check_folder, insert, write
from talbot.base.paths import RESULTS, ROOT
from talbot.models.parameters import ParameterError
from talbot.models.parameters.registers import register_map

from . import exports, registers, tables
from .c_header import c_header

DOCUMENTS = "host.md", "chip.md", "stream.md"
HEADER = Path(__file__).parents[1] / "asp_chip_registers.h"


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot document`."""
    parser.add_argument("--out", type=Path, default=ROOT / "docs", help="folder of host.md, chip.md and stream.md")
    parser.add_argument("--header", type=Path, default=HEADER, help="the C header")
    parser.add_argument("--exports", type=Path, default=RESULTS / "registers", help="folder of the map for other tools")


def run(options: Namespace) -> int:
    """Write every file. Raises ParameterError before the first."""
    check_file("header", options.header)
    check_folder("exports", options.exports)
    for name in DOCUMENTS:
        if not (options.out / name).is_file():
            raise ParameterError(f"out = {str(options.out)!r}: must be a folder with {name}")
    chip = register_map()
    write(options.out / "registers.md", registers.markdown(chip))
    write(options.out / "registers.html", registers.html(chip))
    write(options.header, c_header(chip))
    exports.export(options.exports)
    for mark, table in tables.TABLES.items():
        insert(options.out / "host.md", mark, table())
    for name in DOCUMENTS[1:]:
        insert(options.out / name, "tile", tables.tile_order())
    return 0
