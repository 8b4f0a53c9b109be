"""Sizes as a Markdown table."""


def markdown(sizes):
    """Table of Size objects, in the order given."""
    lines = ["# Sizes", "",
             "Yosys (synth, dfflibmap, abc) with `cells/gates.lib`, an abstract library of no process; a gate is a"
             " NAND2 equivalent.", "Written by `python -m flow.sizes`; a top includes everything below it.", "",
             "| top | cells | flip-flops | gates | of them in flip-flops |", "|---|---:|---:|---:|---:|"]
    lines += [f"| {s.top} | {s.cells:,} | {s.flip_flops:,} | {s.gates:,.0f} | {s.flip_flop_gates:,.0f} |"
              for s in sizes]
    return "\n".join(lines) + "\n"
