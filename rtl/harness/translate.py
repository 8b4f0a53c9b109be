"""PyMTL's Verilog of a component as one readable text, the same bytes from run to run.

Module names have no parameters in them, paths are relative to the repository, and types are named as in the sources.
"""

import os
import re
import tempfile
import warnings
from pathlib import Path

from pymtl3 import Component
from pymtl3.passes.backends.verilog import VerilogTranslationPass

from base.paths import ROOT

COLUMNS = "200"  # PyMTL folds lines at the terminal's width
KEPT = {"Synchronizer": "stages"}  # module -> the register that synthesis may neither merge nor move


def module_names(top: Component, name: str) -> dict[Component, str]:
    """Module name of every component in the elaborated ``top``, whose own is ``name``.

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
    """The module without constants that PyMTL declares and does not use: widths of slices."""
    for name in re.findall(r"(?m)^  localparam .*? (\w+)\s+=", module):
        if len(re.findall(rf"\b{name}\b", module)) == 1:
            module = re.sub(rf"(?m)^  localparam .*? {name}\s+=.*\n", "", module)
    return module


def _with_kept_register(module: str) -> str:
    """The module with an attribute at its register of KEPT."""
    for name, register in KEPT.items():
        if re.search(rf"(?m)^module {name}$", module):
            module = re.sub(rf"(?m)^  (logic .*\b{register};)$", r'  (* keep, async_reg = "true" *) \1', module)
    return module


def tidy(text: str) -> str:
    """PyMTL's Verilog without absolute paths, fields in type names, one-bit loop counters and unused constants.

    The registers of synchronizers have the attribute `keep`.
    """
    text = text.replace(f"// At {ROOT}{os.sep}", "// At ")
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
    lines = [line.rstrip() for line in text.splitlines()]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip() + "\n"


def translate_component(top: Component, name: str) -> str:
    """The Verilog of the unelaborated component ``top`` as module ``name``, as text."""
    top.elaborate()
    for component, module in module_names(top, name).items():
        component.set_metadata(VerilogTranslationPass.explicit_module_name, module)
    top.set_metadata(VerilogTranslationPass.enable, True)
    before, columns = Path.cwd(), os.environ.get("COLUMNS")
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # PyMTL3 3.1.17's translator warns about its own code
        os.chdir(folder)  # it writes into the working directory
        os.environ["COLUMNS"] = COLUMNS
        try:
            top.apply(VerilogTranslationPass())
            return tidy(Path(top.get_metadata(VerilogTranslationPass.translated_filename)).read_text())
        finally:
            os.chdir(before)
            if columns is None:
                os.environ.pop("COLUMNS")
            else:
                os.environ["COLUMNS"] = columns
