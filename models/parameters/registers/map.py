"""asp_chip.rdl -> fields with addresses: what RTL, host and document are generated from."""

from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

SOURCE = Path(__file__).parent / "asp_chip.rdl"


@dataclass(frozen=True)
class Field:
    """One field of a register.

    register, name: as in the source; an array's register carries its index, 'trim[3]'.
    address: byte address of the register, 0..127. size: its bytes. lsb, width: bits in the register,
    little-endian over its bytes. reset: value out of reset. access: 'ro', 'rw', 'wo' or 'w1c' (sticky,
    cleared by writing 1). signed: two's complement. description: one line.
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
    description: str

    @property
    def key(self):
        """The field's name, with its register where that is one of an array: 'threshold', 'trim[3].trim'."""
        return f"{self.register}.{self.name}" if "[" in self.register else self.name

    @property
    def byte(self):
        """Address of the byte that holds the field's lowest bit."""
        return self.address + self.lsb // 8

    @property
    def shift(self):
        """Position of the lowest bit in that byte."""
        return self.lsb % 8

    @property
    def bytes(self):
        """How many bytes the field touches."""
        return (self.shift + self.width + 7) // 8


@dataclass(frozen=True)
class RegisterMap:
    """All fields in ascending order of their bits; no two registers share a byte."""

    fields: tuple

    @cached_property
    def _by_name(self):
        return {f.key: f for f in self.fields}

    def __getitem__(self, name):
        """The field of a key: 'threshold', 'trim[3].trim'. KeyError if there is none."""
        return self._by_name[name]

    @cached_property
    def configuration(self):
        """The fields that a frame reads and that are locked while it runs: tuple, ascending, contiguous bytes."""
        return tuple(f for f in self.fields if f.access == "rw")

    @cached_property
    def trims(self):
        """The trim fields by pixel type: tuple."""
        return tuple(f for f in self.fields if f.name == "trim")

    @cached_property
    def counters(self):
        """The eight-byte fields that are taken as a whole at the read of their first byte: tuple, ascending."""
        return tuple(f for f in self.fields if f.access == "ro" and f.width == 64)

    def image(self, fields, values=None):
        """Bytes of ``fields``: dict address -> byte, from ``values`` (key -> int, cut to the width) or the resets."""
        values = values or {}
        out = {}
        for f in fields:
            bits = (values.get(f.key, f.reset) & ((1 << f.width) - 1)) << f.shift
            for i in range(f.bytes):
                out[f.byte + i] = out.get(f.byte + i, 0) | bits >> 8 * i & 0xFF
        return out

    def writable(self):
        """The bits that a host can set in the configuration: dict address -> byte."""
        return self.image(self.configuration, {f.key: -1 for f in self.configuration})


def _access(node):
    if node.get_property("onwrite") is not None:
        return "w1c"
    sw = node.get_property("sw").name
    return {"r": "ro", "w": "wo"}.get(sw, sw)


def _fields(register):
    name = register.get_path_segment()
    for node in register.fields():
        yield Field(
            register=name,
            name=node.inst_name,
            address=register.absolute_address,
            size=register.size,
            lsb=node.lsb,
            width=node.width,
            reset=node.get_property("reset", default=0),
            access=_access(node),
            signed=bool(node.get_property("signed_value", default=False)),
            description=" ".join(node.get_property("desc").split()),
        )


@cache
def register_map():
    """The chip's RegisterMap (0.1 s at the first call, most of it the compiler's import)."""
    from systemrdl import RDLCompiler  # only what needs the map pays for its compiler

    compiler = RDLCompiler()
    compiler.compile_file(str(SOURCE))
    top = compiler.elaborate().top
    return RegisterMap(tuple(f for register in top.registers(unroll=True) for f in _fields(register)))


def trim_range():
    """Lowest and highest value of a trim register."""
    width = register_map().trims[0].width
    return -(1 << width - 1), (1 << width - 1) - 1
