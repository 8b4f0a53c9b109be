"""SKY130's pads as netlists for ngspice: SkyWater's transistor models, fingers of one clamp as one device.

Junctions of a clamp's fingers are as large as drawn. Two fingers share a drain of 1.53 um, each has a source of 0.685
um; in the core's clamp two share every diffusion, of 0.77 um. BSIM4 has their avalanche breakdown (12.6 V for n, soft
from 11 V on) and no parasitic bipolar transistor, which would turn a clamp on earlier. Diodes behind a resistor are
left out: they would lower the voltage at a gate.
"""

import re
from collections import Counter

from talbot.platforms.sky130 import models

FINGER_UM, END_UM = 0.765, 0.28  # of diffusion on either side of a gate: of a clamp, of another transistor
THIN_FINGER_UM = 0.385  # of a clamp of thin oxide
_TRANSISTOR = re.compile(r"M(\S+) (\S+) (\S+) (\S+) (\S+) (sky130_fd_pr__\w+?)__model l=(\S+) w=(\S+)")
_RESISTOR = re.compile(r"(R\S+) (\S+) (\S+) (\S+) sky130_fd_pr__res\w+ .*")


def lines(spice: str, process: str = "tt", leakage: bool = False) -> list[str]:
    """Lines of a deck: models at ``process`` and the subcircuits of ``spice``, which `DiePads` writes.

    leakage: with the models' variants for it.
    """
    sizes, out = set[tuple[str, float, float]](), list[str]()
    for body in re.findall(r"(?ms)^\.subckt .*?^\.ends[^\n]*", spice):
        fingers = Counter[tuple[str, ...]]()
        for line in body.splitlines():
            if m := _TRANSISTOR.match(line):
                ends = sorted((m[2], m[4]))
                fingers["clamp" if "clamp" in m[1] else "", *ends, m[3], m[5], m[6], m[7], m[8]] += 1
            elif not line.startswith("D"):
                m = _RESISTOR.match(line)
                out.append((" ".join(m.groups()) if m else line).replace("[", "_").replace("]", "_"))
        end = out.pop()
        for k, ((kind, low, high, gate, bulk, model, *size), count) in enumerate(fingers.items()):
            length, width = (round(1e6 * float(metres), 4) for metres in size)
            sizes.add((model, width, length))
            finger = FINGER_UM if "_g5v0d10v5" in model else THIN_FINGER_UM
            side = finger if kind else END_UM
            junctions = f"ad={side * width:g} as={side * width:g} pd={side + width:g} ps={side + width:g}"
            out.append(f"X{k} {low} {gate} {high} {bulk} {model} w={width:g} l={length:g} {junctions} m={count}")
        out.append(end)
    return [*models.cards("binned", process, sizes, leakage), *out]
