"""Transistors' tables by which circuits are sized: transconductance over current, current and gate capacitance a width.

Each role and length of the process's SIZED is one transistor of WIDTH at half the supply, typical corner, 27 degrees,
its gate swept. `talbot/platforms/<process>/gm_id.json` keeps them; `make analog GM_ID=` writes it.
"""

import json
from types import ModuleType

import numpy as np
import numpy.typing as npt

from talbot.pixels.pixel_circuit.deck import analyse

WIDTH = 10.0  # um
DRAIN = 0.4  # V between drain and source
SWEEP = (0.1, 1.4, 0.02)  # V at the gate
LEAST = 1e-9  # A/um of width below which nothing is sized
COLUMNS = ("id", "gm", "gds", "cgg")


def tables(process: ModuleType) -> dict[str, dict[str, list[float]]]:
    """By role and length: "efficiency" gm/Id (1/V, falling), "density" A/um, "gate" F/um, "gain" gm/gds."""
    return {f"{role} {length:g}": _table(process, role, length) for role, length in process.SIZED}


def text(found: dict[str, dict[str, list[float]]]) -> str:
    """JSON with a list a line."""
    parts = (
        f' "{name}": {{\n' + ",\n".join(f'  "{key}": {json.dumps(values)}' for key, values in one.items()) + "\n }"
        for name, one in found.items()
    )
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _table(process: ModuleType, role: str, length: float) -> dict[str, list[float]]:
    current, gm, gds, gate = np.abs(swept(process, role, length))
    keep = current / WIDTH > LEAST
    efficiency = (gm / current)[keep]
    falling = np.r_[True, efficiency[1:] < np.minimum.accumulate(efficiency)[:-1]]
    columns = {
        "efficiency": efficiency,
        "density": current[keep] / WIDTH,
        "gate": gate[keep] / WIDTH,
        "gain": (gm / gds)[keep],
    }
    return {name: [float(f"{value:.4g}") for value in column[falling]] for name, column in columns.items()}


def swept(process: ModuleType, role: str, length: float) -> npt.NDArray[np.float64]:
    """COLUMNS of one transistor over SWEEP, (4, points). Raises ToolError."""
    sign = -1 if role.startswith("p") else 1
    first, last, step = (sign * volts for volts in SWEEP)
    device = f"@m.xm.m{process.ROLES[role]}"
    values = [f"{device}[{name}]" for name in COLUMNS]
    lines = [
        ".option gmin=1e-15",
        *process.cards("tt", {(role, WIDTH, length)}),
        ".temp 27",
        f"Vd d 0 {sign * DRAIN:g}",
        "Vg g 0 0",
        process.instance("m", ("d", "g", "0", "0"), role, WIDTH, length),
        f".save {' '.join(values)}",
    ]
    return analyse(lines, [f"dc Vg {first:g} {last:g} {step:g}"], values)
