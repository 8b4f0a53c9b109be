"""Design rules and layout against circuit of the test chip: the decks of pixels and of analog circuits together."""

from pathlib import Path

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.pixels.layout.circuit import Diode, spice
from talbot.pixels.pixel_layout.checks import with_diodes
from talbot.pixels.post_layout import checks as analog
from talbot.pixels.test_chip.circuit import ANALOG, GROUND, HIGH, INPUTS, LOGIC, NAME, VDDA, pixels
from talbot.pixels.test_chip.draw import HEIGHT, STRIPE_ENDS, STRIPES, TIED, TestChip
from talbot.platforms.analog import AnalogMasks
from talbot.platforms.extraction import extraction_platform
from talbot.platforms.layout import layout_platform
from talbot.platforms.sky130.tinytapeout import ANALOG_PORTS, PORT_UM
from talbot.signoff.geometry.decks import broken_rules, is_circuit
from talbot.signoff.parasitics.shapes import METAL_LEVEL, shapes

COMPARE = "\nok = compare\n"
PORTS = *INPUTS, *ANALOG, GROUND, LOGIC, HIGH  # pins that something is on
PIXEL = "pixel"
FOURTH = METAL_LEVEL + 4  # level of the pins


def drc(gds: Path, masks: AnalogMasks, report: Path) -> dict[str, int]:
    """Violations by rule. report: KLayout's report database. Raises StepError."""
    text = analog.decks(masks.base.name)[0] + masks.base.masks.read_text(encoding="utf-8")
    return broken_rules({report.with_suffix(".drc"): text}, gds, report)


def netlist(chip: TestChip, masks: AnalogMasks) -> str:
    """Return the chip's circuit as text for LVS, pixels and all."""
    base = masks.base
    ring = Diode("ring", VDDA, *chip.array.well_ring_um)
    one = spice(PIXEL, chip.array.pixels[0].circuit, base.deck_model, base.deck_diode)
    lines = [f".subckt {NAME} {' '.join(PORTS)}", *pixels(PIXEL, ring, base.deck_diode)]
    lines += [
        f"M{t.name} {' '.join(t.nodes)} {masks.models[t.role]} W={t.w:.6g}U L={t.l:.6g}U"
        for t in (device.transistor for device in chip.devices)
    ]
    return "\n".join([f"{one.rstrip()}", *lines, f".ends {NAME}", ""])


def lvs(gds: Path, text: str, masks: AnalogMasks, report: Path) -> bool:
    """Return whether ``gds`` is the circuit ``text``, pin by pin. Raises StepError."""
    deck = with_diodes(analog.decks(masks.base.name)[1], masks.base)
    if deck.count(COMPARE) != 1:
        raise StepError("lvs: the deck must have one line 'ok = compare'")
    named = "".join(f'same_nets!("{NAME}", "{port}", "{port}")\n' for port in PORTS)
    return is_circuit(deck.replace(COMPARE, f"\n{named}{COMPARE[1:]}"), gds, text, report)


def untied(layout: "db.Layout", masks: AnalogMasks) -> list[str]:
    """Return unused outputs that are not on ground; LVS has no separate names for them."""
    pdk, places = masks.base.name, dict(ANALOG_PORTS)
    found = shapes(layout, layout.top_cell(), layout_platform(pdk), extraction_platform(pdk))

    def net(x: float, y: float) -> int:
        box = found.at(FOURTH, round(x / layout.dbu), round(y / layout.dbu))
        return int(found.nets[box]) if box >= 0 else -1

    ground = net(STRIPES[GROUND], sum(STRIPE_ENDS) / 2)
    return [name for name in TIED if ground < 0 or net(places[name], HEIGHT - PORT_UM[1] / 2) != ground]
