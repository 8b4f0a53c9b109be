"""PyMTL's Verilog of a component as one readable text, the same bytes from run to run.

Module names have no parameters in them, paths are relative to the repository, and types are named as in the sources.
"""

import os
import re
import tempfile
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from pymtl3 import Component, InPort, Interface, OutPort
from pymtl3.passes.backends.verilog import VerilogTranslationPass

from talbot.base.paths import PACKAGE

COLUMNS = "200"  # PyMTL folds lines at the terminal's width
WORD = re.compile(r"\w+")
KEPT = {"Synchronizer": "stages"}  # module -> the register that synthesis may neither merge nor move


def module_names(top: Component, name: str) -> dict[Component, str]:
    """Return the module name of every component in the elaborated ``top``, which is named ``name``.

    It is the class's name; where a design holds a class with several parameter sets, the later ones (in the order
    of their instance names) are numbered: Queue, Queue_2.
    """
    names, sets, taken = {top: name}, {}, {name}
    for component in sorted(top.get_all_components(), key=repr):
        if component is top:
            continue
        cls = type(component).__name__
        key = (cls, repr(component._dsl.args), repr(sorted(component._dsl.kwargs.items())))
        if key not in sets:
            number = 1
            while (candidate := cls if number == 1 else f"{cls}_{number}") in taken:
                number += 1
            sets[key] = candidate
            taken.add(candidate)
        names[component] = sets[key]
    return names


def _without_unused_constants(module: str) -> str:
    """Return the module without constants that PyMTL declares and does not use: widths of slices."""
    words = Counter(WORD.findall(module))
    for constant in re.finditer(r"(?m)^  localparam .*? (\w+)\s+=.*\n", module):
        if words[constant[1]] == 1:
            module = module.replace(constant[0], "", 1)
            words -= Counter(WORD.findall(constant[0]))
    return module


def _with_kept_register(module: str) -> str:
    """Return the module with an attribute at its register of KEPT."""
    for name, register in KEPT.items():
        if re.search(rf"(?m)^module {name}$", module):
            module = re.sub(rf"(?m)^  (logic .*\b{register};)$", r'  (* keep, async_reg = "true" *) \1', module)
    return module


BIT_0 = re.compile(r"(?<![.\w])(\w+)\[0(?::0)?\]")
VECTOR_OF_ONE = re.compile(r"(?m)^(\s*(?:input +|output |localparam )?)logic \[0:0\] (\w+)((?: +\[\d+:\d+\])?)")


def _scalars(part: str, before: str, text: str) -> str:
    """``part`` without [0:0], but where a bit of the name, with ``before`` in front, is selected in ``text``."""
    selected = {  # with or without a dimension
        False: set(re.findall(rf"{before}(\w+)(?=\[)", text)),
        True: set(re.findall(rf"{before}(\w+)(?=\[[^\]]*\]\[)", text)),
    }

    def scalar(declaration: re.Match[str]) -> str:
        start, name, dimension = declaration.groups()
        return declaration[0] if name in selected[bool(dimension)] else f"{start}logic {name}{dimension}"

    return VECTOR_OF_ONE.sub(scalar, part)


def _without_vectors_of_one(text: str) -> str:
    """Return the text with one-bit signals, fields and constants as scalars; the bit 0 of a signal is the signal."""
    types, *modules = re.split(r"(?m)^(?=module )", text)
    parts = [_scalars(types, r"\.", text)]
    for module in modules:
        bits = {name for _, name, dimension in VECTOR_OF_ONE.findall(module) if not dimension}
        module = BIT_0.sub(lambda match, bits=bits: match[1] if match[1] in bits else match[0], module)
        parts.append(_scalars(module, r"(?<![.\w])", module))
    return "".join(parts)


def _declared(owner: object, prefix: str = "") -> Iterator[str]:
    """Yield port names as in Verilog, in the order of declaration, those of an interface together."""
    for name, value in vars(owner).items():
        if name.startswith("_"):
            continue
        for i, element in enumerate(value if isinstance(value, list) else [value]):
            path = f"{prefix}{name}__{i}" if isinstance(value, list) else f"{prefix}{name}"
            if isinstance(element, (InPort, OutPort)):
                yield from (path, f"{prefix}{name}")
            elif isinstance(element, Interface):
                yield from _declared(element, f"{path}__")


def _with_ordered_ports(text: str, names: dict[Component, str]) -> str:
    """Return the text with the ports of every module in the order of declaration, clock and reset first."""
    order = {module: ["clk", "reset", *_declared(component)] for component, module in names.items()}

    def header(match: re.Match[str]) -> str:
        module, ports = match.groups()
        lines = [line.rstrip(" ,") for line in ports.splitlines()]
        place = {name: i for i, name in reversed([*enumerate(order[module])])}
        lines.sort(key=lambda line: place[re.findall(r"(?<!\[)\b[a-zA-Z_]\w*", line)[-1]])
        return f"module {module}\n(\n" + ",\n".join(lines) + "\n);"

    return re.sub(r"(?ms)^module (\w+)\n\(\n(.*?)\n\);", header, text)


def tidy(text: str) -> str:
    """Return PyMTL's Verilog without absolute paths, fields in type names, one-bit loop counters, unused constants.

    Its first lines name the file as it is written, <top>.sv. A bit is no vector [0:0]. The registers of synchronizers
    have the attribute `keep`.
    """
    text = re.sub(r"(?m)^// (\w+)\.v$", r"// \1.sv", text, count=1)
    text = text.replace(f"// At {PACKAGE}{os.sep}", "// At ")
    text = re.sub(r"(?m)^(\s*// At )/.*/(pymtl3/\S+)$", r"\1\2", text)
    text = re.sub(r"(int unsigned \w+ = )1'd0;", r"\g<1>32'd0;", text)
    text = re.sub(r"\+= 1'd1 \)", "+= 32'd1 )", text)
    text = text.replace("always_comb begin", "always @* begin")  # Icarus 11.0 loops in always_comb (its issue 508)
    structs = sorted(set(re.findall(r"(?m)^} (\w+);", text)))
    short = [name.partition("__")[0] for name in structs]
    for name, plain in zip(structs, short, strict=True):
        if short.count(plain) == 1:
            text = re.sub(rf"\b{name}\b", plain, text)
    text = "endmodule".join(_with_kept_register(_without_unused_constants(m)) for m in text.split("endmodule"))
    text = _without_vectors_of_one(text)
    lines = [line.rstrip() for line in text.splitlines()]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip() + "\n"


def translate_component(top: Component, name: str) -> str:
    """Return the Verilog of the unelaborated component ``top`` as module ``name``."""
    top.elaborate()
    names = module_names(top, name)
    for component, module in names.items():
        component.set_metadata(VerilogTranslationPass.explicit_module_name, module)
    top.set_metadata(VerilogTranslationPass.enable, True)
    before, columns = Path.cwd(), os.environ.get("COLUMNS")
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # PyMTL3 3.1.17's translator warns about its own code
        os.chdir(folder)  # it writes into the working directory
        os.environ["COLUMNS"] = COLUMNS
        try:
            top.apply(VerilogTranslationPass())
            text = Path(top.get_metadata(VerilogTranslationPass.translated_filename)).read_text(encoding="utf-8")
            return tidy(_with_ordered_ports(text, names))
        finally:
            os.chdir(before)
            if columns is None:
                os.environ.pop("COLUMNS")
            else:
                os.environ["COLUMNS"] = columns
