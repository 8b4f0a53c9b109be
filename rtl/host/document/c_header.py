"""The register map as a C header."""

from collections.abc import Iterator, Sequence
from textwrap import wrap

from talbot.models.digital.host import WRITE
from talbot.models.digital.registers import ADDRESS_MAX
from talbot.models.parameters.registers import Field, RegisterMap

HEAD = """\
/* Registers of AspChip. Generated from models/parameters/registers/asp_chip.rdl by `talbot document`.
 *
 * Of each field: _ADDRESS of the byte with its lowest bit, _SHIFT of this bit there, _WIDTH in bits, _DEFAULT after a
 * reset, and of a field in one byte _MASK, its bits there.
 * A field of more than a byte is little-endian. Meaning and access: docs/registers.md, docs/host.md. */
#ifndef ASP_CHIP_REGISTERS_H
#define ASP_CHIP_REGISTERS_H
"""


def c_header(chip: RegisterMap) -> str:
    """Text of asp_chip_registers.h."""
    trim = chip.trims[0]
    config = [f for f in chip.configuration if f not in chip.trims]
    lines = [
        HEAD,
        f"#define ASP_WRITE {WRITE:#04x}u /* bit 7 of a transfer's first byte; the others are the address */",
        f"#define ASP_ADDRESS_MAX {ADDRESS_MAX:#04x}u /* the address stops counting here */",
        "",
        *_range("CONFIGURATION", chip.configuration),
        *_range("COUNTERS", chip.counters),
        f"#define ASP_TRIMS {len(chip.trims)}u /* ASP_TRIM_* is that of pixel type 0 */",
        f"#define ASP_TRIM_SIZE {trim.size}u /* bytes from one to the next */",
        "",
        *_list("ASP_IDENTITY_FIELDS", "Constants of a chip", chip.identity),
        *_list("ASP_CONFIGURATION_FIELDS", "The configuration but the trims", config),
        *_list("ASP_COUNTER_FIELDS", "The counters", chip.counters),
    ]
    for f in [f for f in chip.fields if f not in chip.trims[1:]]:
        lines += ["", *(f"/* {line} */" for line in wrap(f"{f.name} ({f.access}): {f.description}", 110)), *_field(f)]
    return "\n".join([*lines, "", "#endif", ""])


def _range(name: str, fields: Sequence[Field]) -> Iterator[str]:
    """Yield the bytes that hold fields."""
    first, last = fields[0].byte, fields[-1].address + fields[-1].size
    yield f"#define ASP_{name}_ADDRESS {first:#04x}u"
    yield f"#define ASP_{name}_SIZE {last - first}u"


def _list(name: str, what: str, fields: Sequence[Field]) -> list[str]:
    """Return a macro that calls its argument FIELD(name, NAME) for every field."""
    calls = [f"    FIELD({f.name}, {f.name.upper()})" for f in fields]
    return (
        [f"/* {what}, ascending: FIELD(name, stem of its macros) */", f"#define {name}(FIELD) \\"]
        + [f"{call} \\" for call in calls[:-1]]
        + [calls[-1], ""]
    )


def _field(f: Field) -> Iterator[str]:
    for what, text in (
        ("ADDRESS", f"0x{f.byte:02x}u"),
        ("SHIFT", f"{f.shift}u"),
        ("WIDTH", f"{f.width}u"),
        ("DEFAULT", f"{f.reset:#x}u"),
    ):
        yield f"#define ASP_{f.name.upper()}_{what} {text}"
    if f.bytes == 1:
        yield f"#define ASP_{f.name.upper()}_MASK {((1 << f.width) - 1) << f.shift:#04x}u"
    if f.choices:
        names = ", ".join(f"ASP_{f.name.upper()}_{name.upper()} = {value}" for value, name in f.choices)
        yield f"enum asp_{f.name} {{ {names} }};"
