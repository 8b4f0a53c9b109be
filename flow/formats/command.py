"""Token formats and scan orders of the byte stream compared, and the stream with general coders: build/formats/."""

import sys
import tempfile
from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import Any

from talbot.base.charts import save
from talbot.base.files import insert, marked, staged
from talbot.base.paths import RESULTS
from talbot.base.progress import each
from talbot.base.table import write_csv
from talbot.flow.sizes.measure import YOSYS_MISSING, yosys_installed
from talbot.flow.sizes.measure import measure as size_of
from talbot.rtl.verilog import export_verilog

from . import company
from .codes import codes_of, load_codes
from .measure import THRESHOLDS, growth, measure
from .table import chart, lines, markdown, page, tables
from .tokens import FORMATS

DEFAULT_THRESHOLD = 10
MARKS = "formats", "company"  # of the document


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot formats`."""
    out = RESULTS / "formats"
    parser.add_argument("--out", type=Path, default=out, help="folder of formats.csv, .md and .png, and of the page")
    parser.add_argument("--codes", type=Path, help="npz with codes and ideal, both (rows, cols), in place of the scene")
    parser.add_argument("--document", type=Path, help="also put the tables between the marks of this Markdown file")


def run(options: Namespace) -> int:
    """Measure every format in every order, write and print the tables."""
    if options.document:
        for mark in MARKS[:1] if options.codes else MARKS:
            marked(options.document, mark)
    codes, ideal = load_codes(options.codes) if options.codes else codes_of()
    source = f"`{options.codes.name}`" if options.codes else "the edge codes of the default scene"
    rows = measure(codes, ideal, THRESHOLDS, lambda every: each(every, "threshold", str))
    growths = {name: growth(encoder) for name, (encoder, _) in FORMATS.items()}
    found = tables(rows, gates_of_packers(), growths, DEFAULT_THRESHOLD)
    beside: list[dict[str, Any]] = []
    for name in [] if options.codes else each(company.SCENES, "scene", str):
        beside += company.compare(name, codes_of(name)[0])
    in_company = company.tables(beside, DEFAULT_THRESHOLD) if beside else []
    text = markdown(found, source)
    with staged(options.out) as part:
        write_csv(part / "formats.csv", rows)
        if beside:
            write_csv(part / "company.csv", beside)
        (part / "formats.md").write_text(
            f"# Token formats and scan orders\n\n{text}\n{lines(in_company)}", encoding="utf-8"
        )
        save(chart(rows), part / "formats.png")
        (part / "report.html").write_text(page([*found, *in_company], chart(rows), source), encoding="utf-8")
    if options.document:
        insert(options.document, MARKS[0], text)
        if beside:
            insert(options.document, MARKS[1], lines(in_company))
    print(text, lines(in_company), sep="\n", end="")
    print(f"look at {options.out / 'report.html'}", file=sys.stderr)
    return 0


def gates_of_packers() -> dict[str, float] | None:
    """NAND2 equivalents of every format's packer by format, or None where Yosys is missing. Raises ToolError."""
    if not yosys_installed():
        print(f"sizes left out: {YOSYS_MISSING}", file=sys.stderr)
        return None
    packers = {name: packer for name, (_, packer) in FORMATS.items()}
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        export_verilog(Path(folder), list(packers.values()))
        return {name: size_of(Path(folder) / f"{packer}.sv", packer).gates for name, packer in packers.items()}
