"""The measured comparison as Markdown and charts."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from matplotlib.figure import Figure

from base.charts import curves

from .orders import CHIP, ORDERS
from .tokens import CHOSEN, FORMATS


def _line(cells: Iterable[object]) -> str:
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def _table(head: Sequence[str], lines: Iterable[Iterable[object]]) -> list[str]:
    return [_line(head), "|---" + "|---:" * (len(head) - 1) + "|", *map(_line, lines)]


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
    here = {(r["order"], r["format"]): r["ratio"] for r in rows if r["threshold"] == threshold}
    known = next(r for r in rows if r["threshold"] == threshold)
    out = [
        "# Token formats and scan orders",
        "",
        f"Measured on {source}, by `talbot formats`.",
        "",
        f"Threshold {threshold}: {known['psnr_db']:.1f} dB, {100 * known['not_zero']:.1f} % of the samples are "
        f"not zero, and their zero-order entropy allows {known['entropy_ratio']:.2f} : 1. Compression (a byte a "
        "sample over all bytes of the frame), what random codes grow by, and gates of the packer:",
        "",
    ]
    out += _table(
        ["format", *ORDERS, "noise grows", "gates"],
        [
            [
                name,
                *(f"{here[order, name]:.2f}" for order in ORDERS),
                f"{100 * (growths[name] - 1):+.1f} %",
                f"{gates[name]:,.0f}" if gates else "needs Yosys",
            ]
            for name in FORMATS
        ],
    )
    out += [
        "",
        *_table(
            ["order", "must be held", "a wrong byte costs"],
            [[name, order.buffer, order.lost] for name, order in ORDERS.items()],
        ),
    ]
    out += ["", f"{CHOSEN[0].upper()}{CHOSEN[1:]}, {CHIP}:", ""]
    out += _table(
        ["threshold", "PSNR, dB", "not zero", "bytes", "compression", "entropy allows"],
        [
            [
                r["threshold"],
                f"{r['psnr_db']:.2f}",
                f"{100 * r['not_zero']:.1f} %",
                f"{r['bytes']:,}",
                f"{r['ratio']:.2f}",
                f"{r['entropy_ratio']:.2f}",
            ]
            for r in rows
            if (r["order"], r["format"]) == (CHIP, CHOSEN)
        ],
    )
    return "\n".join(out) + "\n"


def chart(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Compression against PSNR of every format in the chip's order, and what the entropy allows."""
    series = {
        name: [
            (r["psnr_db"], r["ratio"], f"T={r['threshold']}" if name == CHOSEN else "")
            for r in rows
            if (r["order"], r["format"]) == (CHIP, name)
        ]
        for name in FORMATS
    }
    series["zero-order entropy"] = [
        (r["psnr_db"], r["entropy_ratio"], "") for r in rows if (r["order"], r["format"]) == (CHIP, CHOSEN)
    ]
    return curves(series, "PSNR of the codes sent (dB)", "compression", f"Token formats, {CHIP}", log_y=True)
