"""The register map as Markdown and as a page."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from talbot.base.page import render
from talbot.base.table import markdown_table
from talbot.models.parameters.registers import Field, RegisterMap

NOTE = (
    "Generated from models/parameters/registers/asp_chip.rdl by talbot document. Byte addresses, little-endian. "
    "Access: ro read only, rw read and write (the configuration), wo write only (reads 0), w1c sticky, cleared by "
    "writing 1; then the reset value, if not 0. Other addresses and bits read 0 and ignore writes."
)
COLUMNS = "address[bits]", "field", "access", "meaning"


@dataclass(frozen=True)
class Row:
    """A field of the map; of a register array the first field, and ``more``, the number of registers after it."""

    field: Field
    more: int = 0

    @property
    def cells(self) -> tuple[str, ...]:
        """Return the row's texts, in the order of COLUMNS."""
        f, high = self.field, self.field.lsb + self.field.width - 1
        register = f.register.partition("[")[0]
        name = f"{register}[0..{self.more}]" if self.more else f.name if f.name == register else f"{register}.{f.name}"
        bits = f"{high}:{f.lsb}" if f.width > 1 else f"{f.lsb}"
        index = f" + {f.size} i " if self.more else ""
        return (
            f"0x{f.address:02X}{index}[{bits}]",
            name,
            f"{f.access}, {f.reset:#x}" if f.reset > 9 else f"{f.access}, {f.reset}" if f.reset else f.access,
            f.description,
        )


def rows(chip: RegisterMap) -> Iterator[Row]:
    """Yield the rows of the map, by ascending address."""
    arrays: dict[str, list[Field]] = {}
    for f in chip.fields:
        arrays.setdefault(f.register.partition("[")[0], []).append(f)
    for fields in arrays.values():
        yield from [Row(fields[0], len(fields) - 1)] if "[" in fields[0].register else map(Row, fields)


def markdown(chip: RegisterMap) -> str:
    """Return the map as a Markdown document."""
    note = f"{NOTE} How a host uses them: [host.md](host.md)."
    return f"# Registers of AspChip\n\n{note}\n\n{markdown_table(COLUMNS, (row.cells for row in rows(chip)))}\n"


def html(chip: RegisterMap) -> str:
    """Return the map as an HTML page."""
    table = [[cell.replace("`", "") for cell in row.cells] for row in rows(chip)]
    return (
        render(
            Path(__file__).with_name("registers.html"),
            "Registers of AspChip",
            listed=True,
            note=NOTE,
            columns=COLUMNS,
            table=table,
        )
        + "\n"
    )
