"""A Liberty file with areas and functions only, for a library that is not characterized: no figure of time in it."""

FUNCTIONS = {"inv": "!i", "buf": "i", "mux2": "(cmd&i1)|((!cmd)&i0)", "xor2": "i0^i1", "nexor2": "!(i0^i1)",
             "and21nor": "!((i0&i1)|i2)", "or21nand": "!((i0|i1)&i2)", "zero": "0", "one": "1",
             **{f"{word}{n}": form.format(sign.join(f"i{k}" for k in range(n))) for n in (2, 3, 4) for word, form, sign
                in (("nand", "!({})", "&"), ("nor", "!({})", "|"), ("and", "{}", "&"), ("or", "{}", "|"))}}
FLIP_FLOPS = {"dff": "", "dffnr": 'clear : "!nrst"; '}
OUTPUTS = ("q", "nq", "zero", "one")


def liberty(ports, areas):
    """Text of the Liberty file. ports: dict cell -> its pins, supplies left out; areas: dict cell -> um2."""
    lines = ["library(cells) {", " delay_model : table_lookup;"]
    for cell, pins in ports.items():
        kind = cell.partition("_")[0]
        outputs = [pin for pin in pins if pin in OUTPUTS]
        if kind not in FUNCTIONS and kind not in FLIP_FLOPS:
            continue
        lines.append(f" cell({cell}) {{ area : {areas[cell]};")
        if kind in FLIP_FLOPS:
            lines.append(f'  ff(IQ,IQN) {{ clocked_on : "clk"; next_state : "i"; {FLIP_FLOPS[kind]}}}')
        for pin in pins:
            if pin in outputs:
                function = "IQ" if kind in FLIP_FLOPS else FUNCTIONS[kind]
                lines.append(f'  pin({pin}) {{ direction : output; function : "{function}"; }}')
            else:
                lines.append(f"  pin({pin}) {{ direction : input; }}")
        lines.append(" }")
    return "\n".join([*lines, "}", ""])
