"""The measured comparison as Markdown and charts."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from matplotlib.figure import Figure

from talbot.base.charts import curves, svg
from talbot.base.page import TABLES, Section, render

from .orders import CHIP, ORDERS
from .tokens import CHOSEN, FORMATS


class Table(NamedTuple):
    """A table after a text. rows: of anything that has a text, their first a name."""

    text: str
    head: Sequence[str]
    rows: Sequence[Sequence[object]]

    def markdown(self) -> list[str]:
        """Lines of Markdown."""
        first, *lines = [f"| {' | '.join(map(str, cells))} |" for cells in (self.head, *self.rows)]
        return [*([self.text, ""] if self.text else []), first, "|---" + "|---:" * (len(self.head) - 1) + "|", *lines]


def tables(
    rows: Sequence[Mapping[str, Any]], gates: Mapping[str, float] | None, growths: Mapping[str, float], threshold: int
) -> list[Table]:
    """Formats at ``threshold`` in every order, the orders, the chosen format at every threshold.

    rows: of `measure`. gates: format -> NAND2 equivalents, or None where Yosys is missing. growths: format -> ratio.
    """
    at = [r for r in rows if r["threshold"] == threshold]
    ratios = {(r["order"], r["format"]): f"{r['ratio']:.2f}" for r in at}
    chosen = [r for r in rows if (r["order"], r["format"]) == (CHIP, CHOSEN)]

    def share(row: Mapping[str, Any]) -> str:
        return f"{100 * row['not_zero']:.1f} %"

    formats = [
        [name, *(ratios[order, name] for order in ORDERS), f"{100 * (growths[name] - 1):+.1f} %"]
        + [f"{gates[name]:,.0f}" if gates else "needs Yosys"]
        for name in FORMATS
    ]
    thresholds = [
        [r["threshold"], f"{r['psnr_db']:.2f}", share(r), f"{r['stream']:,}"]
        + [f"{r['ratio'] * r['bytes'] / r['stream']:.2f}", f"{r['entropy_ratio']:.2f}"]
        for r in chosen
    ]
    about = (
        f"Threshold {threshold}: {at[0]['psnr_db']:.1f} dB, {share(at[0])} of the samples are "
        f"not zero, and their zero-order entropy allows {at[0]['entropy_ratio']:.2f} : 1. Compression (a byte a "
        "sample over all bytes of the frame, a mark after every part that the order cuts it into), what random codes "
        "grow by, and gates of the packer:"
    )
    return [
        Table(about, ["format", *ORDERS, "noise grows", "gates"], formats),
        Table("", ["order", "must be held", "a wrong byte costs"], [[n, o.buffer, o.lost] for n, o in ORDERS.items()]),
        Table(
            "The chip's stream, with its default segments:",
            ["threshold", "PSNR, dB", "not zero", "bytes", "compression", "entropy allows"],
            thresholds,
        ),
    ]


def markdown(found: Sequence[Table], source: str) -> str:
    """The tables of the formats as Markdown. source: what was measured, in words."""
    return f"Measured on {source}, by `talbot formats`.\n\n{lines(found)}"


def lines(found: Sequence[Table]) -> str:
    """Tables as Markdown."""
    return "\n".join("\n".join([*table.markdown(), ""]) for table in found)


def page(found: Sequence[Table], drawn: Figure, source: str) -> str:
    """The tables and the chart of the formats as a page."""
    sections = [Section(charts=[svg(drawn)])]
    for table in found:
        rows = [list(map(str, row)) for row in table.rows]
        sections.append(Section(text=table.text, head=table.head, rows=rows))
    about = f"measured on {source.replace('`', '')}, by make formats"
    return render(TABLES, "Token formats and scan orders", about=about, sections=sections)


def chart(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Compression against PSNR of every format in the chip's order, and what the entropy allows."""
    series: dict[str, list[tuple[float, float, str]]] = {}
    for r in rows:
        if r["order"] == CHIP:
            label = f"T={r['threshold']}" if r["format"] == CHOSEN else ""
            series.setdefault(r["format"], []).append((r["psnr_db"], r["ratio"], label))
    chosen = [r for r in rows if (r["order"], r["format"]) == (CHIP, CHOSEN)]
    series["zero-order entropy"] = [(r["psnr_db"], r["entropy_ratio"], "") for r in chosen]
    return curves(series, "PSNR of the codes sent (dB)", "compression", f"Token formats, {CHIP}", log_y=True)
