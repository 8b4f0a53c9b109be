"""The register map as Markdown."""

from argparse import ArgumentParser, Namespace

from .map import Field, RegisterMap, register_map


def markdown(chip: RegisterMap) -> str:
    """Register map as one Markdown table; the registers of an array share a row.

    Parameters
    ----------
    chip : RegisterMap
        All fields.

    Returns
    -------
    str
        Title, note and table.
    """
    lines = [
        "# Register map of AspChip",
        "",
        "Generated from `models/parameters/registers/asp_chip.rdl` by `talbot registers`.",
        "Byte addresses; fields of more than a byte are little-endian. SPI protocol: rtl/reg_file/README.md.",
        "",
        "| address | register | bits | field | access | reset | meaning |",
        "|---|---|---|---|---|---|---|",
    ]
    arrays: dict[str, list[Field]] = {}
    for f in chip.fields:
        arrays.setdefault(f.register.partition("[")[0], []).append(f)
    for name, fields in arrays.items():
        indexed = "[" in fields[0].register
        for f in fields[:1] if indexed else fields:
            address = f"0x{f.address:02X}" + (f" + {f.size} i" if indexed else "")
            register = f"{name}[0..{len(fields) - 1}]" if indexed else name
            bits = f"{f.lsb + f.width - 1}:{f.lsb}" if f.width > 1 else f"{f.lsb}"
            cells = address, register, bits, f.name, f.access, f"{f.reset:#x}", f.description
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot registers`: none.

    Parameters
    ----------
    parser : ArgumentParser
        Of the command.
    """


def run(options: Namespace) -> int:
    """Print the register map.

    Parameters
    ----------
    options : Namespace
        Empty.

    Returns
    -------
    int
        0, the exit status.
    """
    print(markdown(register_map()), end="")
    return 0
