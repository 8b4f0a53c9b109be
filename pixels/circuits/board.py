"""What is between the board's reference sources and the lanes: decoupling, bond, and the drawn metal across all lanes.

source --R--+-- bond R L -- pin -- riser --+-- strap --+-- strap --+-- ...
            |                              |           |           |
          board C                        chip C      lanes       lanes
"""

from collections.abc import Sequence
from dataclasses import dataclass

from talbot.models.parameters import check_real

REFERENCES = "refp", "refn", "vcm"
SQUARE = 0.047  # ohm, of the third and fourth metal
RISER, STRAP = 350 / 2, 100 / 4  # squares: from the pin to the straps, and of a strap from lane to lane


@dataclass(frozen=True)
class Board:
    """Parts of each reference.

    Attributes
    ----------
    source : float
        Ohm of the source, 1e-3..1e4.
    farad, farad_ohm, farad_henry : float
        Capacitor at the package: F, 1e-12..1e-3, its resistance, 0..10 ohm, its inductance and the board's, 0..1e-7 H.
    bond_ohm, bond_henry : float
        Bond wire and lead, 0..10 ohm, 0..1e-7 H.
    chip : float
        F on the chip between refp and refn, and as much between vcm and the ground, 0..1e-8.
    """

    source: float = 10.0
    farad: float = 100e-9
    farad_ohm: float = 0.03
    farad_henry: float = 1e-9
    bond_ohm: float = 0.1
    bond_henry: float = 4e-9
    chip: float = 0.0

    def __post_init__(self) -> None:
        ranges = {"source": (1e-3, 1e4), "farad": (1e-12, 1e-3), "farad_ohm": (0, 10), "farad_henry": (0, 1e-7)}
        ranges |= {"bond_ohm": (0, 10), "bond_henry": (0, 1e-7), "chip": (0, 1e-8)}
        for name, (low, high) in ranges.items():
            check_real(name, getattr(self, name), low, high)

    def lines(self, groups: Sequence[int]) -> list[str]:
        """Return lines of a deck from <name>_ext to <name><group>, of every reference.

        groups: lanes of each group, the farthest from the pin first; those of one do the same, and one stands for them.
        """
        deck = []
        for name in REFERENCES:
            deck += [
                f"Rsource_{name} {name}_ext {name}_board {self.source:g}",
                f"Cboard_{name} {name}_board {name}_esr {self.farad:g}",
                f"Resr_{name} {name}_esr {name}_esl {self.farad_ohm + 1e-3:g}",
                f"Lesl_{name} {name}_esl 0 {self.farad_henry + 1e-15:g}",
                f"Lbond_{name} {name}_board {name}_bond {self.bond_henry + 1e-15:g}",
                f"Rbond_{name} {name}_bond {name}_pin {self.bond_ohm + 1e-3:g}",
            ]
            before, last = f"{name}_pin", RISER
            for k, times in reversed(list(enumerate(groups))):
                deck += [
                    f"Rway_{name}{k} {before} {name}_at{k} {last * SQUARE:g}",
                    f"Vshare_{name}{k} {name}_at{k} {name}{k} 0",
                    f"Fshare_{name}{k} {name}_at{k} 0 Vshare_{name}{k} {times - 1}",
                ]
                before, last = f"{name}_at{k}", STRAP * times
        if self.chip:
            near = len(groups) - 1
            deck += [f"Cchip refp_at{near} refn_at{near} {self.chip:g}", f"Cchip_vcm vcm_at{near} 0 {self.chip:g}"]
        return deck
