"""RV32I of Proc: the instruction table, encoding, decoding and semantics [Waterman2019]."""

from dataclasses import dataclass

from talbot.models.parameters import ParameterError

MASK = 0xFFFFFFFF
EBREAK = 0x00100073
HART_ID, FROM_MANAGER, TO_MANAGER = 0xF14, 0xFC0, 0x7C0  # the CSRs: mhartid; the manager's words in and out
READABLE, WRITABLE = (HART_ID, FROM_MANAGER), (TO_MANAGER,)

# name: format, opcode, funct3, funct7
BRANCHES = {"beq": 0, "bne": 1, "blt": 4, "bge": 5, "bltu": 6, "bgeu": 7}
LOADS = {"lb": 0, "lh": 1, "lw": 2, "lbu": 4, "lhu": 5}
STORES = {"sb": 0, "sh": 1, "sw": 2}
IMMEDIATE = {"addi": 0, "slti": 2, "sltiu": 3, "xori": 4, "ori": 6, "andi": 7}
SHIFTS = {"slli": (1, 0), "srli": (5, 0), "srai": (5, 0x20)}
REGISTER = {
    "add": (0, 0),
    "sub": (0, 0x20),
    "sll": (1, 0),
    "slt": (2, 0),
    "sltu": (3, 0),
    "xor": (4, 0),
    "srl": (5, 0),
    "sra": (5, 0x20),
    "or": (6, 0),
    "and": (7, 0),
}
TABLE: dict[str, tuple[str, int, int | None, int | None]] = {
    "lui": ("U", 0x37, None, None),
    "auipc": ("U", 0x17, None, None),
    "jal": ("J", 0x6F, None, None),
    "jalr": ("I", 0x67, 0, None),
    **{name: ("B", 0x63, funct3, None) for name, funct3 in BRANCHES.items()},
    **{name: ("I", 0x03, funct3, None) for name, funct3 in LOADS.items()},
    **{name: ("S", 0x23, funct3, None) for name, funct3 in STORES.items()},
    **{name: ("I", 0x13, funct3, None) for name, funct3 in IMMEDIATE.items()},
    **{name: ("H", 0x13, *functs) for name, functs in SHIFTS.items()},
    **{name: ("R", 0x33, *functs) for name, functs in REGISTER.items()},
    "fence": ("I", 0x0F, 0, None),
    "csrw": ("W", 0x73, 1, None),
    "csrr": ("C", 0x73, 2, None),
}
NAMES = {fields[1:]: name for name, fields in TABLE.items()}
# format: least and largest immediate, and what it is a multiple of
RANGES = {
    "I": (-2048, 2047, 1),
    "S": (-2048, 2047, 1),
    "H": (0, 31, 1),
    "C": (0, 4095, 1),
    "W": (0, 4095, 1),
    "B": (-4096, 4094, 2),
    "U": (0, 2**20 - 1, 1),
    "J": (-(2**20), 2**20 - 2, 2),
    "R": (0, 0, 1),
}


@dataclass(frozen=True)
class Instruction:
    """An instruction; imm as the processor adds it, of lui and auipc shifted; a field that it lacks is 0."""

    name: str
    rd: int = 0
    rs1: int = 0
    rs2: int = 0
    imm: int = 0


def signed(value: int, bits: int = 32) -> int:
    """Return the low ``bits`` of ``value`` as a two's complement number."""
    value &= (1 << bits) - 1
    return value - (value >> (bits - 1) << bits)


def encode(name: str, rd: int = 0, rs1: int = 0, rs2: int = 0, imm: int = 0) -> int:
    """Return the word of an instruction; imm of lui and auipc: the upper 20 bits. Raises ParameterError."""
    if name not in TABLE:
        raise ParameterError(f"instruction = {name!r}: must be one of {', '.join(TABLE)}")
    form, opcode, funct3, funct7 = TABLE[name]
    for field, register in (("rd", rd), ("rs1", rs1), ("rs2", rs2)):
        if not 0 <= register < 32:
            raise ParameterError(f"{field} = {register}: must be 0..31")
    least, largest, step = RANGES[form]
    if not least <= imm <= largest or imm % step:
        raise ParameterError(f"imm = {imm} of {name}: must be {least}..{largest}, a multiple of {step}")
    word = opcode | (funct3 or 0) << 12 | (funct7 or 0) << 25
    if form in "SB":
        word |= rs1 << 15 | rs2 << 20
        if form == "S":
            return word | (imm & 0x1F) << 7 | (imm >> 5 & 0x7F) << 25
        return word | (imm >> 11 & 1) << 7 | (imm >> 1 & 0xF) << 8 | (imm >> 5 & 0x3F) << 25 | (imm >> 12 & 1) << 31
    word |= rd << 7
    if form == "U":
        return word | imm << 12
    if form == "J":
        parts = (imm >> 12 & 0xFF) << 12 | (imm >> 11 & 1) << 20 | (imm >> 1 & 0x3FF) << 21 | (imm >> 20 & 1) << 31
        return word | parts
    word |= rs1 << 15
    return word | (rs2 << 20 if form == "R" else (imm & 0xFFF) << 20)


def decode(word: int) -> Instruction | None:
    """Return the instruction of a word; None for one that stops the processor."""
    opcode, funct3, funct7 = word & 0x7F, word >> 12 & 7, word >> 25
    rd, rs1, rs2 = word >> 7 & 31, word >> 15 & 31, word >> 20 & 31
    keys = (opcode, None, None), (opcode, funct3, None), (opcode, funct3, funct7)
    name = next((NAMES[key] for key in keys if key in NAMES), None)
    if name is None:
        return None
    form, high = TABLE[name][0], signed(word) >> 20
    if form == "R":
        return Instruction(name, rd, rs1, rs2)
    if form == "H":
        return Instruction(name, rd, rs1, imm=rs2)
    if form == "U":
        return Instruction(name, rd, imm=word & 0xFFFFF000)
    if form == "J":
        imm = high & ~0xFFFFF | word & 0xFF000 | (high & 1) << 11 | high & 0x7FE
        return Instruction(name, rd, imm=signed(imm, 21))
    if form == "S":
        return Instruction(name, rs1=rs1, rs2=rs2, imm=high & ~31 | rd)
    if form == "B":
        return Instruction(name, rs1=rs1, rs2=rs2, imm=signed((high & ~0x81F) | rd & 30 | (rd & 1) << 11, 13))
    if form == "C":
        return Instruction(name, rd, imm=high & 0xFFF) if rs1 == 0 and high & 0xFFF in READABLE else None
    if form == "W":
        return Instruction(name, rs1=rs1, imm=high & 0xFFF) if rd == 0 and high & 0xFFF in WRITABLE else None
    return Instruction(name) if name == "fence" else Instruction(name, rd, rs1, imm=high)


def compute(name: str, a: int, b: int) -> int:
    """Return the result of a register or immediate instruction ``name`` for operands 0..2^32 - 1."""
    shift = b & 31
    results = {
        "add": lambda: a + b,
        "sub": lambda: a - b,
        "sll": lambda: a << shift,
        "slt": lambda: signed(a) < signed(b),
        "sltu": lambda: a < b,
        "xor": lambda: a ^ b,
        "srl": lambda: a >> shift,
        "sra": lambda: signed(a) >> shift,
        "or": lambda: a | b,
        "and": lambda: a & b,
    }
    return int(results["sltu" if name == "sltiu" else name.removesuffix("i")]()) & MASK


def taken(name: str, a: int, b: int) -> bool:
    """Return whether branch ``name`` is taken for operands 0..2^32 - 1."""
    less, equal = (a < b if name.endswith("u") else signed(a) < signed(b)), a == b
    return {"beq": equal, "bne": not equal, "blt": less, "bge": not less}[name.removesuffix("u")]


def lanes(name: str, address: int, data: int) -> tuple[int, int] | None:
    """Return strobe and data of a store's word, 0 for a load; None if the address is no multiple of the size."""
    size = 1 << ((LOADS | STORES)[name] & 3)
    if address % size:
        return None
    if name in LOADS:
        return 0, 0
    part = data & ((1 << 8 * size) - 1)
    return ((1 << size) - 1) << (address & 3), sum(part << 8 * at for at in range(0, 4, size))


def loaded(name: str, address: int, word: int) -> int:
    """Return the register's value of load ``name`` from the memory's ``word``."""
    funct3 = LOADS[name]
    bits = 8 << (funct3 & 3)
    part = word >> 8 * (address & 3) & ((1 << bits) - 1)
    return part if funct3 & 4 else signed(part, bits) & MASK
