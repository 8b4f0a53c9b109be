"""Design rules and layout against circuit of drawn analog circuits, by the decks that PDKMaster exports."""

from pathlib import Path

from talbot.base.steps import StepError
from talbot.flow.layout.geometry.decks import broken_rules, is_circuit, without_rules
from talbot.flow.pixel_layout.checks import common_decks
from talbot.platforms.analog import analog_masks


def decks(pdk: str) -> tuple[str, str]:
    """The decks of design rules and of LVS, text. Raises StepError where PDKMaster's are not as they were."""
    masks = analog_masks(pdk)
    rules, lvs = common_decks(pdk)
    text = "\n".join([*rules, masks.rules.read_text(), masks.thick.read_text(), ""])
    text = without_rules(text, masks.contradicted)
    for line, other in masks.connections.items():
        if lvs.count(f"\n{line}\n") != 1:
            raise StepError(f"lvs: the deck has no single line {line!r}")
        lvs = lvs.replace(line, other)
    first, last = "extract_devices(", "\nalign\n"
    if first not in lvs or lvs.count(last) != 1:
        raise StepError("lvs: the deck has no extract_devices, or no single line 'align'")
    lvs = lvs.replace(first, masks.lvs.read_text() + first, 1)
    return text, lvs.replace(last, f"{last}netlist.simplify\nschematic.simplify\n")


def drc(gds: Path, pdk: str, report: Path) -> dict[str, int]:
    """Violations by rule. report: KLayout's report database. Raises StepError."""
    return broken_rules(decks(pdk)[0], gds, report)


def lvs(gds: Path, spice: str, pdk: str, report: Path) -> bool:
    """Whether the top cell of ``gds`` is the circuit ``spice``, text. Raises StepError."""
    return is_circuit(decks(pdk)[1], gds, spice, report)
