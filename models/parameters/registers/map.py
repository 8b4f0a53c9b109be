"""Fields and addresses of asp_chip.rdl, from which RTL, host and document are generated."""

import contextlib
import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import astuple, dataclass, replace
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, cast

from talbot.models.parameters.divider import DIVIDERS, NO_DIVIDER

if TYPE_CHECKING:
    from systemrdl.node import AddrmapNode, FieldNode, RegNode

SOURCE = Path(__file__).parent / "asp_chip.rdl"
KEPT = SOURCE.parent / "__pycache__" / "asp_chip.json"


@dataclass(frozen=True)
class Field:
    """One field of a register.

    Attributes
    ----------
    register, name : str
        As in the source; a register of an array carries its index, 'trim[3]'.
    address : int
        Byte address of the register, 0..127.
    size : int
        Bytes of the register.
    lsb, width : int
        Bits in the register, little-endian over its bytes.
    reset : int
        Value after reset.
    access : str
        'ro', 'rw', 'wo' or 'w1c' (sticky, cleared by writing 1).
    signed : bool
        Two's complement.
    constant : bool
        Built into the chip.
    choices : tuple of (int, str)
        Names of its values, if they have some.
    description : str
        Meaning, one line, with the choices.
    """

    register: str
    name: str
    address: int
    size: int
    lsb: int
    width: int
    reset: int
    access: str
    signed: bool
    constant: bool
    choices: tuple[tuple[int, str], ...]
    description: str

    @property
    def key(self) -> str:
        """Name of the field, with its register if that is one of an array: 'threshold', 'trim[3].trim'."""
        return f"{self.register}.{self.name}" if "[" in self.register else self.name

    @property
    def range(self) -> tuple[int, int]:
        """Lowest and highest value."""
        return (-(1 << self.width - 1), (1 << self.width - 1) - 1) if self.signed else (0, (1 << self.width) - 1)

    @property
    def byte(self) -> int:
        """Address of the byte that holds the field's lowest bit."""
        return self.address + self.lsb // 8

    @property
    def shift(self) -> int:
        """Position of the lowest bit in that byte."""
        return self.lsb % 8

    @property
    def bytes(self) -> int:
        """Number of bytes that hold a bit of the field."""
        return (self.shift + self.width + 7) // 8


@dataclass(frozen=True)
class RegisterMap:
    """All fields; no two registers share a byte.

    Attributes
    ----------
    fields : tuple of Field
        In ascending order of their bits.
    """

    fields: tuple[Field, ...]

    @cached_property
    def _by_name(self) -> dict[str, Field]:
        return {f.key: f for f in self.fields}

    def __getitem__(self, name: str) -> Field:
        """Field of a key: 'threshold', 'trim[3].trim'. Raises KeyError for an unknown key."""
        return self._by_name[name]

    @cached_property
    def configuration(self) -> tuple[Field, ...]:
        """Fields that a frame reads and that are locked while it runs: ascending, contiguous bytes."""
        return tuple(f for f in self.fields if f.access == "rw")

    @cached_property
    def identity(self) -> tuple[Field, ...]:
        """Constants by which a host knows the chip."""
        return tuple(f for f in self.fields if f.constant)

    @cached_property
    def trims(self) -> tuple[Field, ...]:
        """Trim fields by pixel type."""
        return tuple(f for f in self.fields if f.name == "trim")

    @cached_property
    def counters(self) -> tuple[Field, ...]:
        """Eight-byte fields, ascending; a read of the first byte takes a snapshot of all eight."""
        return tuple(f for f in self.fields if f.access == "ro" and f.width == 64)

    @cached_property
    def state(self) -> tuple[Field, ...]:
        """Fields of the register `state`."""
        return tuple(f for f in self.fields if f.register == "state")

    def with_resets(self, resets: Mapping[str, int]) -> "RegisterMap":
        """Return the same map with other values after reset.

        resets: key to value, as `array_resets` has them. Returns the map of a chip of another sensor.
        """
        return RegisterMap(tuple(replace(f, reset=resets.get(f.key, f.reset)) for f in self.fields))

    def image(self, fields: Iterable[Field], values: Mapping[str, int] | None = None) -> dict[int, int]:
        """Contents of the bytes that hold some fields.

        fields: fields to store. values: key to value, cut to the field's width; the reset value where a key is missing.
        Returns address to byte.
        """
        values = values or {}
        out: dict[int, int] = {}
        for f in fields:
            bits = (values.get(f.key, f.reset) & ((1 << f.width) - 1)) << f.shift
            for i in range(f.bytes):
                out[f.byte + i] = out.get(f.byte + i, 0) | bits >> 8 * i & 0xFF
        return out

    def writable(self) -> dict[int, int]:
        """Bits that a host can set in the configuration.

        Returns address to mask of the byte.
        """
        return self.image(self.configuration, {f.key: -1 for f in self.configuration})


def _access(node: "FieldNode") -> str:
    if node.get_property("onwrite") is not None:
        return "w1c"
    sw = node.get_property("sw").name
    return {"r": "ro", "w": "wo"}.get(sw, sw)


def _fields(register: "RegNode") -> Iterator[Field]:
    name = register.get_path_segment()
    for node in register.fields():
        choices = tuple(node.get_property("encode") or ())
        named = ", ".join(f"{c.value} {c.name}" + (f" ({c.rdl_desc})" if c.rdl_desc else "") for c in choices)
        text = str(node.get_property("desc")) + (f" {named}." if named else "")
        yield Field(
            register=name,
            name=node.inst_name,
            address=register.absolute_address,
            size=register.size,
            lsb=node.lsb,
            width=node.width,
            reset=cast(int, node.get_property("reset", default=0)),
            access=_access(node),
            signed=bool(node.get_property("signed_value", default=False)),
            constant=node.get_property("hw").name == "na",
            choices=tuple((c.value, c.name) for c in choices),
            description=" ".join(text.split()),
        )


def compiled(resets: Mapping[str, int] | None = None) -> "AddrmapNode":
    """Compile asp_chip.rdl: the chip's address map, for exporters of other formats.

    resets: values after reset that replace those of the source, by field. Returns the chip.
    """
    from systemrdl.compiler import RDLCompiler  # imported where it is needed: it is slow

    compiler = RDLCompiler()
    compiler.compile_file(str(SOURCE))
    chip = compiler.elaborate().top
    for register in chip.registers(unroll=True):
        for node in register.fields():
            if resets and node.inst_name in resets:
                node.inst.properties["reset"] = resets[node.inst_name]
    return chip


@cache
def register_map() -> RegisterMap:
    """Register map of the chip, kept as Python keeps modules: compiling it again takes longer than a frame."""
    key = hashlib.sha256(SOURCE.read_bytes() + Path(__file__).read_bytes()).hexdigest()
    if fields := _kept(key):
        return RegisterMap(fields)
    registers = compiled().registers(unroll=True)
    fields = tuple(f for register in registers for f in _fields(register))
    values = [astuple(f) for f in fields]
    part = KEPT.with_name(f"{KEPT.name}.{os.getpid()}")
    with contextlib.suppress(OSError):  # a folder that only root may write
        KEPT.parent.mkdir(exist_ok=True)
        part.write_text(json.dumps([key, _check(values), values]), encoding="utf-8")
        part.replace(KEPT)
    return RegisterMap(fields)


def _kept(key: str) -> tuple[Field, ...]:
    """Return the fields of an earlier process; none where the file is of another source, or damaged."""
    try:
        of, check, values = json.loads(KEPT.read_text(encoding="utf-8"))
        fields = tuple(replace(Field(*row), choices=tuple(map(tuple, row[-2]))) for row in values)
    except (OSError, ValueError, TypeError):
        return ()
    return fields if of == key and check == _check(values) else ()


def _check(values: object) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()


def trim_range() -> tuple[int, int]:
    """Lowest and highest value of a trim register."""
    return register_map().trims[0].range


def array_resets(
    rows: int, cols: int, lanes: int, tile_rows: int = 4, tile_cols: int = 6, divider: str = "radix4"
) -> dict[str, int]:
    """Values after reset that follow the array: the identity and the window.

    rows, cols, lanes, tile_rows, tile_cols: pixels, converters, pixels of a tile. divider: one of DIVIDERS, or
    NO_DIVIDER. Returns dict of str to int: by field.
    """
    return {
        "row1": -(-rows // tile_rows) - 1,
        "col1": -(-cols // tile_cols) - 1,
        "lanes": lanes,
        "rows": rows,
        "cols": cols,
        "tile_rows": tile_rows,
        "tile_cols": tile_cols,
        "divider": (*DIVIDERS, NO_DIVIDER).index(divider),
    }
