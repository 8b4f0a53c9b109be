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
    """Return the table of docs/results/blocks.md: function, latency, throughput and size of each block."""
    by_top = {s.top: s for s in sizes}
    lines = [
        "| block | what it does | latency | throughput | cells | flip-flops | gates |",
        "|---|---|---|---|---:|---:|---:|",
    ]
    for top, about in BLOCKS.items():
        s, folder = by_top[top], FOLDERS.get(top) or re.sub("(?!^)(?=[A-Z])", "_", top).lower()
        cells = [f"[{top}](../../rtl/{folder}/README.md)", *about]
        cells += [f"{s.cells:,}", f"{s.flip_flops:,}", f"{s.gates:,.0f}"]
        lines.append(f"| {' | '.join(cells)} |")
    lines += [
        "",
        "Gates are NAND2 equivalents of `cells/gates.lib`, an abstract library; a block includes all below it.",
    ]
    return "\n".join(lines)


# top: what it does, latency, throughput; each block's README has the contract and its tests hold it
BLOCKS = {
    "AmpCtrl": ("amplifier control FSM", "a row: its durations", "-"),
    "ReadoutSeq": ("rows, types, groups; what to leave out", "3 cycles to the first message", "1 step a cycle"),
    "EdgeAdc": ("one SAR lane with a zero window", "3 cycles a zero, 11 a code", "a zero in 4 cycles, a code in 10"),
    "AdcBank": ("8 lanes, results in order", "as its lanes", "1 sample a cycle"),
    "QuadDividerRadix2": ("quadrature divider, restoring", "9 cycles", "1 in 10 cycles"),
    "QuadDividerRadix4": ("the same, radix 4", "5 cycles", "1 in 6 cycles"),
    "QuadDividerPipelined": ("the same, pipelined", "9 cycles", "1 a cycle"),
    "Cordic": ("CORDIC vectoring, 10 iterations", "11 cycles", "1 in 12 cycles"),
    "PhasePath": ("four taps to phase and amplitude", "-", "as its divider"),
    "RunLength": ("encoder of the byte stream", "-", "1 sample and 1 byte a cycle"),
    "RegFile": ("registers behind SPI mode 0", "a byte: 8 SPI clocks", "-"),
    "AspChip": ("the whole digital chip", "a frame", "1 sample a cycle"),
}
# Folders whose name is not the top's in snake case
FOLDERS = dict.fromkeys([top for top in BLOCKS if top.startswith("QuadDivider") or top == "Cordic"], "quad_divider")
