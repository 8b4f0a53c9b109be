"""What place and route must know of a laid-out cell, as a LEF macro: outline, pins, obstructions, antenna areas.

A pin is all metal of its net, as SkyWater's abstracts have it; every other net's metal is an obstruction. Antenna:
the gate area on an input (W x L), the diffusion area on any signal (LEF 5.8: ANTENNAGATEAREA, ANTENNADIFFAREA).
"""

from dataclasses import dataclass

import klayout.db as db

from cells.extract.devices import find, read_cell
from models.parameters import ParameterError
from platforms.layers import DIFFUSION

DIRECTIONS = ("INPUT", "OUTPUT", "INOUT")
USES = ("SIGNAL", "CLOCK", "POWER", "GROUND")


@dataclass(frozen=True)
class Pin:
    """direction: INPUT, OUTPUT or INOUT; use: SIGNAL, CLOCK, POWER or GROUND."""

    direction: str
    use: str = "SIGNAL"

    def __post_init__(self):
        if self.direction not in DIRECTIONS:
            raise ParameterError(f"direction = {self.direction!r}: must be one of {', '.join(DIRECTIONS)}")
        if self.use not in USES:
            raise ParameterError(f"use = {self.use!r}: must be one of {', '.join(USES)}")


def header(site, width, height):
    """LEF of a library's start: version and its placement ``site`` (a name) of ``width`` by ``height`` um."""
    return (
        f'VERSION 5.8 ;\nBUSBITCHARS "[]" ;\nDIVIDERCHAR "/" ;\nUNITS\n  DATABASE MICRONS 1000 ;\nEND UNITS\n\n'
        f"SITE {site}\n  CLASS CORE ;\n  SYMMETRY Y ;\n  SIZE {width:.3f} BY {height:.3f} ;\nEND {site}\n\n"
    )


def abstract(gds, name, tech, pins, site):
    """LEF macro of cell ``name`` in the file ``gds``. pins: name -> Pin, in order; site: name of its placement site.

    Wells and poly are left out: rows take care of the first, and nobody
    routes on the second. Raises ParameterError when a pin has no metal in the cell, or the cell no outline.
    """
    found = find(gds, name, tech)
    outline = _outline(gds, name, tech)
    metals = [layer.lef for layer in tech.conductors if layer.lef != "poly"]
    lines = [
        f"MACRO {name}",
        "  CLASS CORE ;",
        f"  FOREIGN {name} ;",
        "  ORIGIN 0.000 0.000 ;",
        f"  SIZE {outline.width():.3f} BY {outline.height():.3f} ;",
        "  SYMMETRY X Y ;",
        f"  SITE {site} ;",
    ]
    for pin, kind in pins.items():
        lines += _pin(pin, kind, found, metals)
    blocked = [(metal, region) for metal in metals for net, region in found.shapes[metal].items() if net not in pins]
    if blocked:
        lines.append("  OBS")
        for metal in metals:
            lines += _layer(metal, _sum(region for name_, region in blocked if name_ == metal), found.dbu, "    ")
        lines.append("  END")
    return "\n".join([*lines, f"END {name}", ""])


def _outline(gds, name, tech):
    layout, cell = read_cell(gds, name)
    boxes = (db.Region(cell.begin_shapes_rec(layout.layer(*layer))).bbox() for layer in tech.outlines)
    for box in boxes:
        if not box.empty():
            return box.to_dtype(layout.dbu)
    raise ParameterError(f"cell = {name!r}: must have an outline on one of the GDS layers {tech.outlines}")


def _pin(pin, kind, found, metals):
    shapes = {metal: found.shapes[metal][pin] for metal in metals if pin in found.shapes[metal]}
    if not shapes:
        raise ParameterError(f"pin = {pin!r}: must be a labelled net with metal in the cell")
    lines = [f"  PIN {pin}"]
    gates = sum(d.w * d.l for d in found.devices if d.gate == pin)
    if kind.use in ("SIGNAL", "CLOCK"):
        diffusion = found.shapes[DIFFUSION].get(pin)
        if gates:
            lines.append(f"    ANTENNAGATEAREA {gates:.4f} ;")
        if diffusion:
            lines.append(f"    ANTENNADIFFAREA {diffusion.area() * found.dbu**2:.4f} ;")
    lines += [f"    DIRECTION {kind.direction} ;", f"    USE {kind.use} ;"]
    if kind.use in ("POWER", "GROUND"):
        lines.append("    SHAPE ABUTMENT ;")
    lines.append("    PORT")
    for metal, region in shapes.items():
        lines += _layer(metal, region, found.dbu, "      ")
    return [*lines, "    END", f"  END {pin}"]


def _layer(metal, region, dbu, indent):
    if region.is_empty():
        return []
    boxes = sorted(
        (b.left, b.bottom, b.right, b.top)
        for b in (p.bbox() for p in region.merged().decompose_trapezoids_to_region().each())
    )
    return [
        f"{indent}LAYER {metal} ;",
        *(f"{indent}  RECT {' '.join(f'{v * dbu:.3f}' for v in box)} ;" for box in boxes),
    ]


def _sum(regions):
    total = db.Region()
    for region in regions:
        total += region
    return total
