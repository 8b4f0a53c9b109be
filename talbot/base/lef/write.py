"""LEF text of macros. Coordinates are in um, with three decimals."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from talbot.base.lef.read import Box

if TYPE_CHECKING:
    import klayout.db as db

HEADER = 'VERSION 5.8 ;\nBUSBITCHARS "[]" ;\nDIVIDERCHAR "/" ;\n'
END = "END LIBRARY\n"


@dataclass(frozen=True)
class Rectangles:
    """Boxes on a layer."""

    layer: str
    boxes: Sequence[Box]


@dataclass(frozen=True)
class Pin:
    """A pin; statements: as LEF words them, without the semicolon."""

    name: str
    statements: Sequence[str]
    shapes: Sequence[Rectangles]


def macro(
    name: str, statements: Sequence[str], pins: Iterable[Pin], obstructions: Sequence[Rectangles] | None = None
) -> str:
    """Text of a macro. obstructions: None leaves out the section."""
    lines = [f"MACRO {name}", *(f"  {statement} ;" for statement in statements)]
    for pin in pins:
        lines += [f"  PIN {pin.name}", *(f"    {statement} ;" for statement in pin.statements), "    PORT"]
        lines += [*_lines(pin.shapes, "      "), "    END", f"  END {pin.name}"]
    if obstructions is not None:
        lines += ["  OBS", *_lines(obstructions, "    "), "  END"]
    return "\n".join([*lines, f"END {name}", ""])


def library(site: str, width_um: float, height_um: float, macros: Iterable[str]) -> str:
    """Text of a library of cells: its placement ``site`` of ``width_um`` by ``height_um``, and ``macros`` (texts)."""
    return (
        f"{HEADER}UNITS\n  DATABASE MICRONS 1000 ;\nEND UNITS\n\n"
        f"SITE {site}\n  CLASS CORE ;\n  SYMMETRY Y ;\n  {size(width_um, height_um)} ;\nEND {site}\n\n"
        + "\n".join(f"{macro.rstrip()}\n" for macro in macros)
        + f"\n{END}"
    )


def size(width_um: float, height_um: float) -> str:
    """Return the statement SIZE."""
    return f"SIZE {width_um:.3f} BY {height_um:.3f}"


def um(box: "db.Box", dbu: float) -> Box:
    """Return a box of KLayout in um; dbu: um a database unit."""
    return box.left * dbu, box.bottom * dbu, box.right * dbu, box.top * dbu


def _lines(shapes: Iterable[Rectangles], indent: str) -> Iterator[str]:
    for part in shapes:
        yield f"{indent}LAYER {part.layer} ;"
        for box in part.boxes:
            yield f"{indent}  RECT {' '.join(f'{value:.3f}' for value in box)} ;"
