"""The measured comparison as Markdown and charts."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from talbot.base.charts import curves

from .orders import CHIP, ORDERS
from .tokens import CHOSEN, FORMATS


def _table(head: Sequence[str], rows: Iterable[Iterable[object]]) -> list[str]:
    first, *lines = [f"| {' | '.join(map(str, cells))} |" for cells in (head, *rows)]
    return [first, "|---" + "|---:" * (len(head) - 1) + "|", *lines]


def markdown(
    rows: Sequence[Mapping[str, Any]],
    gates: Mapping[str, float] | None,
    growths: Mapping[str, float],
    threshold: int,
    source: str,
) -> str:
    """The tables: formats at ``threshold`` in every order, the chosen one at every threshold.

    rows: of `measure`. gates: format -> NAND2 equivalents, or None where Yosys is missing. growths: format -> ratio.
    source: what was measured, in words.
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
    out = [
        "# Token formats and scan orders",
        "",
        f"Measured on {source}, by `talbot formats`.",
        "",
        f"Threshold {threshold}: {at[0]['psnr_db']:.1f} dB, {share(at[0])} of the samples are "
        f"not zero, and their zero-order entropy allows {at[0]['entropy_ratio']:.2f} : 1. Compression (a byte a "
        "sample over all bytes of the frame, a mark after every part that the order cuts it into), what random codes "
        "grow by, and gates of the packer:",
        "",
        *_table(["format", *ORDERS, "noise grows", "gates"], formats),
        "",
        *_table(["order", "must be held", "a wrong byte costs"], [[n, o.buffer, o.lost] for n, o in ORDERS.items()]),
        "",
        "The chip's stream, with its default segments:",
        "",
        *_table(["threshold", "PSNR, dB", "not zero", "bytes", "compression", "entropy allows"], thresholds),
    ]
    return "\n".join(out) + "\n"


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
