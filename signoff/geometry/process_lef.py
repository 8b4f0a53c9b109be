"""Technology and cells of a process as LEF, for place and route: PDKMaster's rules, the cells' own layouts."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from talbot.base.lef import write
from talbot.cells.lef.abstract import PinKind, abstract
from talbot.platforms.extraction import ExtractionPlatform
from talbot.platforms.layers import Layer, Via
from talbot.platforms.layout import LayoutPlatform
from talbot.platforms.place_and_route import PlaceAndRoute
from talbot.signoff.netlist.netlist import DIODE, OUTPUT_PINS

WIDE_UM = 3.0  # from this width on a layer's wide spacing holds
LEAST_AREA_UM2 = 0.0561  # where a layer has no rule: a via's pad with its enclosures
DIFFUSION_UM2 = 0.0125, 0.0225, 22.5  # points of the antenna ratio by diffusion: none counts below the first
SUPPLIES = {"vdd": "POWER", "vss": "GROUND"}


def technology(rules: Mapping[str, Any], tech: LayoutPlatform, tools: PlaceAndRoute) -> str:
    """Text of the technology's LEF. rules: of `pdkmaster.routing_rules`."""
    lines = [*write.HEADER.rstrip().splitlines(), "UNITS", "  DATABASE MICRONS 1000 ;", "END UNITS"]
    lines.append(f"MANUFACTURINGGRID {tech.grid_um:g} ;")
    for k, metal in enumerate(tech.metals):
        lines += _metal(metal, "VERTICAL" if k % 2 == 0 else "HORIZONTAL", rules["metals"][metal.name], tools)
        if k < len(tech.vias):
            lines += _cut(tech.vias[k], rules["vias"][tech.vias[k].name])
    lines += ["LAYER OVERLAP", "  TYPE OVERLAP ;", "END OVERLAP"]
    for via, below, above in zip(tech.vias, tech.metals, tech.metals[1:]):
        lines += _vias(via, below, above, rules["vias"][via.name])
    return "\n".join([*lines, "END LIBRARY", ""])


def _metal(metal: Layer, direction: str, rule: Mapping[str, float], tools: PlaceAndRoute) -> Iterator[str]:
    yield from (f"LAYER {metal.lef}", "  TYPE ROUTING ;", f"  DIRECTION {direction} ;")
    yield from (f"  PITCH {tools.pitch_um[metal.lef]:g} ;", "  OFFSET 0 ;", f"  WIDTH {rule['width']:g} ;")
    yield from ("  SPACINGTABLE", "    PARALLELRUNLENGTH 0")
    wide = rule.get("wide_space", 0.0)
    yield f"    WIDTH 0 {rule['space']:g}" + ("" if wide else " ;")
    if wide:
        yield f"    WIDTH {WIDE_UM:g} {wide:g} ;"
    yield f"  AREA {rule['area'] or LEAST_AREA_UM2:g} ;"
    if metal.min_hole_um2:
        yield f"  MINENCLOSEDAREA {metal.min_hole_um2:g} ;"
    if metal.antenna_ratio:
        slope, base = metal.antenna_diffusion
        none, first, last = DIFFUSION_UM2
        points = [(0, metal.antenna_ratio), (none, metal.antenna_ratio)]
        points += [(first, slope * first + base), (last, slope * last + base)]
        yield from (f"  THICKNESS {metal.thickness_um:g} ;", "  ANTENNAMODEL OXIDE1 ;")
        ratios = " ".join(f"( {area:g} {ratio:g} )" for area, ratio in points)
        yield f"  ANTENNADIFFSIDEAREARATIO PWL ( {ratios} ) ;"
    if metal.sheet_ohm:
        yield f"  RESISTANCE RPERSQ {metal.sheet_ohm:g} ;"
    yield f"END {metal.lef}"


def _cut(via: Via, rule: Mapping[str, Any]) -> Iterator[str]:
    yield from (f"LAYER {via.lef}", "  TYPE CUT ;", f"  WIDTH {via.size_um:g} ;", f"  SPACING {via.space_um:g} ;")
    for side in ("below", "above"):
        yield f"  ENCLOSURE {side.upper()} {rule[side][0]:g} {rule[side][1]:g} ;"
    yield f"END {via.lef}"


def _vias(via: Via, below: Layer, above: Layer, rule: Mapping[str, Any]) -> Iterator[str]:
    """Every form of a via, its enclosures along x or y, and the rule for arrays."""
    half, (low, high) = via.size_um / 2, (rule["below"], rule["above"])
    forms = sorted({(b, a) for b in (tuple(low), tuple(low[::-1])) for a in (tuple(high), tuple(high[::-1]))})
    for number, sides in enumerate(forms):
        yield from (f"VIA {via.lef}_{number} DEFAULT", f"  LAYER {via.lef} ;")
        yield f"    RECT {-half:g} {-half:g} {half:g} {half:g} ;"
        for metal, (x, y) in zip((below, above), sides):
            yield f"  LAYER {metal.lef} ;"
            yield f"    RECT {-half - x:g} {-half - y:g} {half + x:g} {half + y:g} ;"
        yield f"END {via.lef}_{number}"
    step = via.size_um + via.space_um
    yield from (f"VIARULE {via.lef}_array GENERATE", f"  LAYER {below.lef} ;")
    yield from (f"    ENCLOSURE {low[1]:g} {low[0]:g} ;", f"  LAYER {above.lef} ;")
    yield from (f"    ENCLOSURE {high[0]:g} {high[1]:g} ;", f"  LAYER {via.lef} ;")
    yield f"    RECT {-half:g} {-half:g} {half:g} {half:g} ;"
    yield from (f"    SPACING {step:g} BY {step:g} ;", f"END {via.lef}_array")


def library(
    gds: Path, ports: Mapping[str, list[str]], tech: LayoutPlatform, devices: ExtractionPlatform, tools: PlaceAndRoute
) -> str:
    """Text of the cells' LEF, from their layouts in the file ``gds``. ports: of every cell, its supplies too."""

    def kind(cell: str) -> str:
        return "CORE ANTENNACELL" if cell == DIODE else "CORE SPACER" if cell in tech.fill_cells else "CORE"

    def pin(name: str) -> PinKind:
        if name in SUPPLIES:
            return PinKind("INOUT", SUPPLIES[name])
        if name in OUTPUT_PINS:
            return PinKind("OUTPUT")
        return PinKind("INPUT", "CLOCK" if name == "clk" else "SIGNAL")

    macros = (
        abstract(gds, cell, devices, {name: pin(name) for name in names}, tools.site, kind(cell), tech.vias[:1])
        for cell, names in ports.items()
    )
    return write.library(tools.site, tools.site_um, tools.row_um, macros)
