"""The pixel as a circuit, for LVS and SPICE."""

from dataclasses import dataclass

from talbot.models.parameters import check_real

PORTS = "pixel_reset", "read", "column_a", "column_b", "vdda", "vssa"
SIDES = "a", "b"


@dataclass(frozen=True)
class Transistor:
    """A transistor of a pixel; l, w: length and width in um, 0.5..20 and 0.42..100."""

    name: str
    drain: str
    gate: str
    source: str
    w_um: float
    l_um: float

    def __post_init__(self) -> None:
        check_real(f"{self.name} w_um", self.w_um, 0.42, 100)
        check_real(f"{self.name} l_um", self.l_um, 0.5, 20)


@dataclass(frozen=True)
class Diode:
    """A photodiode: its well's area in um2 and perimeter in um."""

    name: str
    node: str
    area_um2: float
    perimeter_um: float


@dataclass(frozen=True)
class Circuit:
    """A pixel: each diode with a reset transistor, a source follower and a select transistor (3T)."""

    transistors: tuple[Transistor, ...]
    diodes: tuple[Diode, ...]


def circuit(well_um: tuple[float, float], w_um: float, l_um: float) -> Circuit:
    """The circuit of a pixel. well_um: width and height of each diode's well. w_um, l_um: of every transistor."""
    width, height = well_um
    transistors, diodes = [], []
    for side in SIDES:
        node, between, column = f"photo_{side}", f"out_{side}", f"column_{side}"
        transistors += [
            Transistor(f"reset_{side}", "vdda", "pixel_reset", node, w_um, l_um),
            Transistor(f"follower_{side}", "vdda", node, between, w_um, l_um),
            Transistor(f"select_{side}", between, "read", column, w_um, l_um),
        ]
        diodes.append(Diode(f"photo_{side}", node, width * height, 2 * (width + height)))
    return Circuit(tuple(transistors), tuple(diodes))


def spice(name: str, circuit: Circuit, transistor: str, diode: str, bulk: str = "vssa") -> str:
    """Return the subcircuit for LVS: M and D devices of these models, sizes in um and um2."""
    lines = [f".subckt {name} {' '.join(PORTS)}"]
    lines += [
        f"M{t.name} {t.drain} {t.gate} {t.source} {bulk} {transistor} W={t.w_um:g}U L={t.l_um:g}U"
        for t in circuit.transistors
    ]
    lines += [f"D{d.name} {bulk} {d.node} {diode} A={d.area_um2:g}P P={d.perimeter_um:g}U" for d in circuit.diodes]
    return "\n".join([*lines, f".ends {name}", ""])


def spice_array(
    name: str, pixel: str, rows: int, cols: int, dummies: int, ring: Diode | None, diode: str, bulk: str = "vssa"
) -> str:
    """Return the subcircuit of an array of subcircuits ``pixel``, with as many dummies on each side.

    Rows of dummies are held in reset and never read; columns of dummies end open. ring: a diode around all.
    """
    ports = [f"{line}_row[{row}]" for line in ("pixel_reset", "read") for row in range(rows)]
    ports += [f"column_{side}[{col}]" for side in SIDES for col in range(cols)]
    lines = [f".subckt {name} {' '.join((*ports, 'vdda', bulk))}"]
    for row in range(-dummies, rows + dummies):
        across = ("pixel_reset", "read") if 0 <= row < rows else ()
        tied = " ".join(f"{line}_row[{row}]" for line in across) or f"vdda {bulk}"
        for col in range(-dummies, cols + dummies):
            inside = 0 <= col < cols
            down = " ".join(f"column_{side}[{col}]" if inside else f"open_{side}_{col + dummies}" for side in SIDES)
            lines.append(f"X{row + dummies}_{col + dummies} {tied} {down} vdda {bulk} {pixel}")
    if ring:
        lines.append(f"D{ring.name} {bulk} {ring.node} {diode} A={ring.area_um2:g}P P={ring.perimeter_um:g}U")
    return "\n".join([*lines, f".ends {name}", ""])
