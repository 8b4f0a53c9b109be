"""Logic gates inside the analog circuits: static CMOS of one width, p transistors twice that of n."""

from talbot.pixels.circuits.netlist import Circuit, Transistor

LENGTH = 0.25  # um: at 0.15 um the p transistors leak 0.6 uA/um at ff, 125 degrees, 1.98 V
SWITCH_LENGTH = 0.15  # um, of switches
UNIT = 0.65  # um, width of an n transistor; p transistors have twice that


def _name(kind: str, strength: int) -> str:
    return f"{kind}_x{strength}"


def inverter(strength: int = 1, length: float = LENGTH) -> Circuit:
    """Pins a y vdd vss. length: um, of both transistors; longer ones are for delay."""
    n, p = UNIT * strength, 2 * UNIT * strength
    return Circuit(
        _name("inv", strength) + ("" if length == LENGTH else f"_l{round(100 * length)}"),
        ("a", "y", "vdd", "vss"),
        (
            Transistor("n", "y", "a", "vss", "vss", "n", n, length),
            Transistor("p", "y", "a", "vdd", "vdd", "p", p, length),
        ),
    )


def nand(strength: int = 1) -> Circuit:
    """Pins a b y vdd vss."""
    n, p = 2 * UNIT * strength, 2 * UNIT * strength
    return Circuit(
        _name("nand", strength),
        ("a", "b", "y", "vdd", "vss"),
        (
            Transistor("na", "y", "a", "m", "vss", "n", n, LENGTH),
            Transistor("nb", "m", "b", "vss", "vss", "n", n, LENGTH),
            Transistor("pa", "y", "a", "vdd", "vdd", "p", p, LENGTH),
            Transistor("pb", "y", "b", "vdd", "vdd", "p", p, LENGTH),
        ),
    )


def nor(strength: int = 1) -> Circuit:
    """Pins a b y vdd vss."""
    n, p = UNIT * strength, 4 * UNIT * strength
    return Circuit(
        _name("nor", strength),
        ("a", "b", "y", "vdd", "vss"),
        (
            Transistor("pa", "m", "a", "vdd", "vdd", "p", p, LENGTH),
            Transistor("pb", "y", "b", "m", "vdd", "p", p, LENGTH),
            Transistor("na", "y", "a", "vss", "vss", "n", n, LENGTH),
            Transistor("nb", "y", "b", "vss", "vss", "n", n, LENGTH),
        ),
    )
