"""Design rules and layout against circuit of drawn analog circuits, by the decks that PDKMaster exports."""

from collections.abc import Iterable
from pathlib import Path

from talbot.base.gds import db
from talbot.base.steps import StepError
from talbot.pixels.pixel_layout.checks import common_decks
from talbot.platforms.analog import analog_masks
from talbot.signoff.geometry.decks import broken_rules, is_circuit
from talbot.signoff.geometry.lvs_deck import hierarchical

ALIGN, COMPARE = "\nalign\n", "\nok = compare\n"


def decks(pdk: str) -> tuple[str, str]:
    """Return the decks of design rules and of LVS, text. Raises StepError where PDKMaster's are not as they were."""
    masks = analog_masks(pdk)
    rules, lvs = common_decks(pdk)
    text = "\n".join([*rules, masks.rules.read_text(encoding="utf-8"), masks.thick.read_text(encoding="utf-8"), ""])
    for line, other in masks.connections.items():
        if lvs.count(f"\n{line}\n") != 1:
            raise StepError(f"lvs: the deck has no single line {line!r}")
        lvs = lvs.replace(line, other)
    first = "extract_devices("
    if first not in lvs or lvs.count(ALIGN) != 1:
        raise StepError("lvs: the deck has no extract_devices, or no single line 'align'")
    lvs = lvs.replace(first, masks.lvs.read_text(encoding="utf-8") + first, 1)
    return text, lvs.replace(ALIGN, f"{ALIGN}netlist.simplify\nschematic.simplify\n")


def drc(gds: Path, pdk: str, report: Path) -> dict[str, int]:
    """Violations by rule. report: KLayout's report database. Raises StepError."""
    return broken_rules({report.with_suffix(".drc"): decks(pdk)[0]}, gds, report)


def lvs(gds: Path, spice: str, pdk: str, report: Path, boxes: Iterable[str] = ()) -> bool:
    """Return whether the top cell of ``gds`` is the last circuit of ``spice``, text, port by port. Raises StepError.

    boxes: cells, their ports labelled, that are compared once, and their instances by their pins; all others are flat.
    What reaches into one from above is a pin that its circuit does not have.

    Without ports of the same name given as matching, two that are swapped at symmetrical places match.
    """
    circuits = [line.split()[1:] for line in spice.splitlines() if line.startswith(".subckt ")]
    compared = [one for one in circuits[:-1] if one[0] in boxes] + circuits[-1:]
    named = "".join(f'same_nets!("{name}", "{port}", "{port}")\n' for name, *ports in compared for port in ports)
    deck = decks(pdk)[1]
    if boxes:
        masks = analog_masks(pdk).base
        deck = hierarchical(deck, masks.active, masks.tap)
        inner = [name for name, *_ in circuits[:-1] if name not in boxes]
        deck = deck.replace(ALIGN, "".join(f'\nschematic.flatten_circuit("{name.upper()}")' for name in inner) + ALIGN)
    if deck.count(COMPARE) != 1:
        raise StepError(f"lvs: the deck has no single line {COMPARE.strip()!r}")
    return is_circuit(deck.replace(COMPARE, f"\n{named}{COMPARE[1:]}"), gds, spice, report)


def differences(report: Path) -> list[str]:
    """Return the differences that `lvs` found, nets first, by the names of the circuit, else of the layout."""
    found = db.LayoutVsSchematic()
    found.read(str(report))
    compared, texts = found.xref(), []
    good, paired = db.NetlistCrossReference.Match, db.NetlistCrossReference.MatchWithWarning
    for pair in compared.each_circuit_pair():
        name = (pair.second() or pair.first()).name
        kinds = ("net", compared.each_net_pair), ("device", compared.each_device_pair)
        for kind, each in (*kinds, ("circuit", compared.each_subcircuit_pair), ("pin", compared.each_pin_pair)):
            for one in each(pair):
                if one.status() != good and (kind == "device" or one.status() != paired):  # paired, but of other sizes
                    texts.append(f"{name}: {kind} {(one.second() or one.first()).expanded_name()}".lower())
    return texts
