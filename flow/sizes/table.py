"""Sizes as a Markdown table."""

import re
from collections.abc import Sequence

from talbot.flow.sizes.measure import Size


def markdown(sizes: Sequence[Size]) -> str:
    """Return a table of ``sizes``, in their order."""
    lines = [
        "# Sizes",
        "",
        "Yosys (synth, dfflibmap, abc) with `cells/gates.lib`, an abstract library of no process; a gate is a"
        " NAND2 equivalent.",
        "Written by `talbot sizes`; a top includes everything below it.",
        "",
        "| top | cells | flip-flops | gates | of them in flip-flops |",
        "|---|---:|---:|---:|---:|",
    ]
    for s in sizes:
        lines.append(f"| {s.top} | {s.cells:,} | {s.flip_flops:,} | {s.gates:,.0f} | {s.flip_flop_gates:,.0f} |")
    return "\n".join(lines) + "\n"


def blocks_table(sizes: Sequence[Size]) -> str:
    """Return the table of docs/results/blocks.md: function and size of each block."""
    by_top = {s.top: s for s in sizes}
    lines = ["| block | what it does | flip-flops | gates |", "|---|---|---:|---:|"]
    for top, about in BLOCKS.items():
        s, folder = by_top[top], FOLDERS.get(top) or re.sub("(?!^)(?=[A-Z])", "_", top).lower()
        cells = [f"[{top}](../../rtl/{folder}/README.md)", about]
        cells += [f"{s.flip_flops:,}", f"{s.gates:,.0f}"]
        lines.append(f"| {' | '.join(cells)} |")
    lines += [
        "",
        "Gates are NAND2 equivalents of `cells/gates.lib`, an abstract library; a block includes all below it.",
    ]
    return "\n".join(lines)


BLOCKS = {
    "AmpCtrl": "amplifier control FSM",
    "ReadoutSeq": "rows, types, groups; what to leave out",
    "EdgeAdc": "one SAR lane with a zero window",
    "AdcBank": "8 lanes, results in order",
    "QuadDividerRadix2": "quadrature divider, restoring",
    "QuadDividerRadix4": "the same, radix 4",
    "QuadDividerPipelined": "the same, pipelined",
    "Cordic": "CORDIC vectoring, 10 iterations",
    "PhasePath": "four taps to phase and amplitude",
    "RunLength": "encoder of the byte stream",
    "RegFile": "registers behind SPI mode 0",
    "AspChip": "the whole digital chip",
}
# Folders whose name is not the top's in snake case
FOLDERS = dict.fromkeys([top for top in BLOCKS if top.startswith("QuadDivider") or top == "Cordic"], "quad_divider")
