"""What a whole die asks of a process beyond the blocks' wires: the thick wire above them. One object a process."""

import importlib
from dataclasses import dataclass

from models.parameters import ParameterError

from .coriolis import Cut, Wire

PROCESSES = ("sky130",)


@dataclass(frozen=True)
class Thick:
    """The wire above the highest of Embedded.wires. lef: its name in LEF. width_um, space_um: least.

    cut: joins it to that highest wire; cut.enclosure_um is that by the thick wire, below_um that by the other.
    """

    wire: Wire
    lef: str
    width_um: float
    space_um: float
    cut: Cut
    below_um: float


def thick(pdk):
    """The Thick of ``pdk``. Raises ParameterError."""
    if pdk not in PROCESSES:
        raise ParameterError(f"pdk = {pdk}: must be one of {', '.join(PROCESSES)} for a whole die")
    return importlib.import_module(f"platforms.{pdk.replace('-', '_')}.die").THICK
