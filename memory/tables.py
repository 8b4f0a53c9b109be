"""Tables of a static RAM's summary, for its page and for docs/results/sram.md."""

from typing import Any

Table = tuple[tuple[str, ...], list[tuple[str, ...]]]
MARKS = "density", "margins", "mismatch", "column"
OPENRAM = "sky130_sram_2kbyte_1rw_32x512_8", 483.86, 326.1  # um, of its LEF: bibliography, OpenRAM


def tables(summary: dict[str, Any]) -> dict[str, Table]:
    """Return head and rows of the tables in MARKS."""
    out = {"density": _density(summary)}
    head = "corner", "hold, V", "read, V", "write, V", "read current, uA"
    out["margins"] = (
        head,
        [
            (corner, *(f"{one[kind]:.2f}" for kind in ("hold", "read", "write")), f"{1e6 * one['current']:.0f}")
            for corner, one in summary["margins"].items()
        ],
    )
    rows = [
        (f"{kind}, {one['corner']}", f"{one['cells']:,}", *(f"{one[key]:.3f}" for key in ("mean", "sigma", "least")))
        + (f"{one['mean'] / one['sigma']:.0f}",)
        for kind, one in summary["mismatch"].items()
    ]
    out["mismatch"] = ("margin", "cells", "mean, V", "sigma, V", "least, V", "mean / sigma"), rows
    head = "corner", "access, ns", "write, ns", "precharge, ns", "cycle, ns", "difference, V", "difference / offset"
    keys = "access", "write", "precharge", "cycle"
    out["column"] = (
        head,
        [
            (corner, *(f"{1e9 * one[key]:.2f}" for key in keys), f"{one['difference']:.2f}")
            + (f"{one['difference'] / summary['sense_offset']:.0f}",)
            for corner, one in summary["column"].items()
        ],
    )
    return out


def _density(summary: dict[str, Any]) -> Table:
    width, height = summary["cell_um"]
    bits, (name, *sides) = summary["words"] * summary["bits"], OPENRAM
    cases = (
        ("a cell", 1, width * height * 1e-6),
        (
            f"{summary['words']} x {summary['bits']} cells with straps, precharge, multiplexers",
            bits,
            summary["array_mm2"],
        ),
        (f"OpenRAM's {name}, whole", 512 * 32, sides[0] * sides[1] * 1e-6),
    )
    rows = [(what, f"{count:,}", f"{mm2:.3g}", f"{count / mm2:,.0f}") for what, count, mm2 in cases]
    return ("", "bits", "mm2", "bits/mm2"), rows
