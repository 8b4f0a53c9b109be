"""Sizes as a Markdown table."""

from collections.abc import Sequence

from .measure import Size


def markdown(sizes: Sequence[Size]) -> str:
    """Table of Size objects, in the order given."""
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
    lines += [
        f"| {s.top} | {s.cells:,} | {s.flip_flops:,} | {s.gates:,.0f} | {s.flip_flop_gates:,.0f} |" for s in sizes
    ]
    return "\n".join(lines) + "\n"


def readme_table(sizes: Sequence[Size]) -> str:
    """Table of the blocks for the README: what each is, its contract's figures, and its size."""
    by_top = {s.top: s for s in sizes}
    lines = [
        "| block | what it does | latency | throughput | levels under one test bench | cells | flip-flops | gates |",
        "|---|---|---|---|---|---:|---:|---:|",
    ]
    for top, (folder, does, latency, throughput, levels) in BLOCKS.items():
        s = by_top[top]
        lines.append(
            f"| [{top}](rtl/{folder}/README.md) | {does} | {latency} | {throughput} | {levels} "
            f"| {s.cells:,} | {s.flip_flops:,} | {s.gates:,.0f} |"
        )
    lines += [
        "",
        "Yosys, `cells/gates.lib` (an abstract library; a gate is a NAND2 equivalent); a block includes all below it.",
        "Verilog runs in Verilator and in Icarus (4-state). Written by `make sizes`.",
    ]
    return "\n".join(lines)


# top: folder, what it does, latency, throughput, levels; each block's README has the contract and its tests hold it
BLOCKS = {
    "AmpCtrl": ("amp_ctrl", "amplifier control FSM", "a row: its durations", "-", "FL = CL, RTL, Verilog"),
    "ReadoutSeq": (
        "readout_seq",
        "rows, types, groups; what to leave out",
        "3 cycles to the first message",
        "1 step a cycle",
        "FL, CL, RTL, Verilog",
    ),
    "EdgeAdc": (
        "edge_adc",
        "one SAR lane with a zero window",
        "3 cycles a zero, 11 a code",
        "a zero in 4 cycles, a code in 10",
        "FL, CL, RTL, Verilog",
    ),
    "AdcBank": ("adc_bank", "8 lanes, results in order", "as its lanes", "1 sample a cycle", "FL, CL, RTL, Verilog"),
    "QuadDividerRadix2": (
        "quad_divider",
        "quadrature divider, restoring",
        "9 cycles",
        "1 in 10 cycles",
        "FL, CL, RTL, Verilog; all 2^18 inputs",
    ),
    "QuadDividerRadix4": (
        "quad_divider",
        "the same, radix 4",
        "5 cycles",
        "1 in 6 cycles",
        "FL, CL, RTL, Verilog; all 2^18 inputs",
    ),
    "QuadDividerPipelined": (
        "quad_divider",
        "the same, pipelined",
        "9 cycles",
        "1 a cycle",
        "FL, CL, RTL, Verilog; all 2^18 inputs",
    ),
    "Cordic": (
        "quad_divider",
        "CORDIC vectoring, 10 iterations",
        "11 cycles",
        "1 in 12 cycles",
        "FL, CL, RTL, Verilog; all 2^18 inputs",
    ),
    "PhasePath": ("phase_path", "four taps to phase and amplitude", "-", "as its divider", "FL, CL, RTL, Verilog"),
    "RunLength": (
        "run_length",
        "encoder of the byte stream",
        "-",
        "1 sample and 1 byte a cycle",
        "FL, CL, RTL, Verilog",
    ),
    "RegFile": ("reg_file", "registers behind SPI mode 0", "a byte: 8 SPI clocks", "-", "FL, RTL, Verilog"),
    "AspChip": (
        "asp_chip",
        "the whole digital chip",
        "a frame",
        "1 sample a cycle",
        "FL, RTL, Verilog; whole frames in Verilator and Icarus",
    ),
}
