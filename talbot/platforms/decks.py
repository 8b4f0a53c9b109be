"""KLayout's decks of design rules and of LVS, as PDKMaster exports them for a process, mended."""

import re
from collections.abc import Iterable
from typing import Any

from talbot.base.steps import StepError
from talbot.platforms.layers import GdsLayer
from talbot.platforms.layout import LayoutPlatform
from talbot.platforms.patience import imported


def export_decks(tech: LayoutPlatform) -> dict[str, str]:
    """Decks for 'drc' (without ``tech.contradicted``) and 'lvs' (with ``tech.lvs``), text. Raises StepError."""
    from pdkmaster.io.klayout import FileExporter

    devices, description = imported(tech.package).prims_spiceparams, imported(f"{tech.package}.pdkmaster")
    exporter: Any = FileExporter(tech=description.tech, gds_layers=description.gds_layers, prims_spiceparams=devices)
    decks = {name: text for name, text in exporter().items() if name in ("drc", "lvs")}
    # pdkmaster-io-klayout 0.1.8 writes a constant that KLayout does not have, where a process spaces wide metal farther
    decks["drc"] = without_rules(decks["drc"].replace(", Projection)", ", projection)"), tech.contradicted)
    if tech.lvs:
        head, devices_begin, tail = decks["lvs"].partition("extract_devices(")
        decks["lvs"] = head + tech.lvs.read_text(encoding="utf-8") + devices_begin + tail
    return {name: with_taps(text, tech.active, tech.tap) if tech.tap else text for name, text in decks.items()}


def with_taps(deck: str, active: GdsLayer, tap: GdsLayer) -> str:
    """A deck with taps on their own mask, too: PDKMaster knows diffusion and taps as one. Raises StepError."""
    old, new = (f"input({layer}, {datatype})" for layer, datatype in (active, tap))
    if deck.count(f" = {old}\n") != 1:
        raise StepError(f"deck: must have one line with {old}, to which the taps are added")
    return deck.replace(f" = {old}\n", f" = {old} + {new}\n")


def without_rules(deck: str, rules: Iterable[str]) -> str:
    """The deck without rules that SkyWater's own transistors break. Raises StepError where one is not there once."""
    for rule in rules:
        deck, count = re.subn(rf"^\(\w+&\w+\)\.output\(\"{re.escape(rule)}\"\)\n", "", deck, flags=re.M)
        if count != 1:
            raise StepError(f"drc: the deck has the rule {rule} {count} times, once was expected")
    return deck
