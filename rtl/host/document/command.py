"""Write the documents for a host: docs/registers.md, the tables of host.md, the C header.

build/registers/ has the map as a page and as IP-XACT (PeakRDL).
"""

import os
import re
from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.files import check_file, check_folder, insert, write
from talbot.base.paths import RESULTS, ROOT
from talbot.base.sensor import Varied, add_sensor, sensor_asked
from talbot.models.parameters import ParameterError
from talbot.rtl.host.document import exports, registers, tables
from talbot.rtl.host.document.c_header import c_header

DOCUMENT, MAP = "host.md", "registers.md"
HEADER = Path(__file__).parents[1] / "asp_chip_registers.h"
DOCS, EXPORTS = ROOT / "docs", RESULTS / "registers"
VARIED = Varied(
    used=("array.rows", "array.cols", "tile", "chip.lanes", "chip.divider", "chip.n_frac", "chip.cordic_iterations")
)
LINK = re.compile(r"(?<=\]\()(?!https?:|#)([^)#]+)")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot document`."""
    add, ours = parser.add_argument, "of a sensor file: build/document/<file>"
    add_sensor(parser)
    add("--out", type=Path, help=f"folder of {DOCUMENT} (default: docs; {ours})")
    add("--header", type=Path, help=f"the C header (default: rtl/host/asp_chip_registers.h; {ours})")
    add("--exports", type=Path, help=f"folder of its page and IP-XACT (default: build/registers; {ours}/registers)")


def run(options: Namespace) -> int:
    """Write every file. Raises ParameterError before the first."""
    sensor = sensor_asked(options, VARIED)
    folder = RESULTS / "document" / options.sensor.stem if options.sensor else DOCS
    out = options.out or folder
    header = options.header or (folder / HEADER.name if options.sensor else HEADER)
    exported = options.exports or (folder / "registers" if options.sensor else EXPORTS)
    if header.parent.exists() or options.header:
        check_file("header", header)
    check_folder("exports", exported)
    if options.sensor and not options.out:
        check_folder("out", out)
        _copy(out)
    if not (out / DOCUMENT).is_file():
        raise ParameterError(f"out = {str(out)!r}: must be a folder with {DOCUMENT}")
    chip = tables.map_of(sensor)
    write(out / MAP, registers.markdown(chip))
    write(header, c_header(chip))
    exports.export(exported, tables.resets_of(sensor))
    for mark, table in tables.TABLES.items():
        insert(out / DOCUMENT, mark, table(sensor))
    print(f"{len(chip.fields)} fields of registers, {len(tables.TABLES)} tables of {DOCUMENT}")
    print(f"  {out}: {MAP}, {DOCUMENT}")
    print(f"  {header}")
    print(f"  {exported}: {exports.PAGE}, {exports.IPXACT}")
    print(f"  look at {exported / exports.PAGE}")
    return 0


def _copy(out: Path) -> None:
    """Copy the document into ``out``, with links to the files that it names."""

    def linked(match: re.Match[str]) -> str:
        return match[1] if match[1] == MAP else os.path.relpath(DOCS / match[1], out)

    write(out / DOCUMENT, LINK.sub(linked, (DOCS / DOCUMENT).read_text(encoding="utf-8")))
