"""A small assembler: the text of a program as bytes for address 0.

A line is `label:`, an instruction of RV32I or one of PSEUDO, `.word VALUE ...`, `.zero BYTES` or `.equ NAME, VALUE`;
`#` starts a comment. A value is a number, a name or a sum of them.
"""

import re
from collections.abc import Mapping

from talbot.models.parameters import ParameterError
from talbot.rtl.proc.isa import EBREAK, LOADS, MASK, STORES, TABLE, encode, signed

REGISTERS = {f"x{n}": n for n in range(32)} | {
    name: n
    for n, name in enumerate(
        "zero ra sp gp tp t0 t1 t2 s0 s1 a0 a1 a2 a3 a4 a5 a6 a7 s2 s3 s4 s5 s6 s7 s8 s9 s10 s11 t3 t4 t5 t6".split()
    )
}
# name: the instruction, with the places of its operands
PSEUDO = {
    "nop": "addi x0, x0, 0",
    "mv": "addi {0}, {1}, 0",
    "not": "xori {0}, {1}, -1",
    "neg": "sub {0}, x0, {1}",
    "seqz": "sltiu {0}, {1}, 1",
    "snez": "sltu {0}, x0, {1}",
    "j": "jal x0, {0}",
    "call": "jal ra, {0}",
    "jr": "jalr x0, {0}, 0",
    "ret": "jalr x0, ra, 0",
    "beqz": "beq {0}, x0, {1}",
    "bnez": "bne {0}, x0, {1}",
    "bltz": "blt {0}, x0, {1}",
    "bgez": "bge {0}, x0, {1}",
    "blez": "bge x0, {0}, {1}",
    "bgtz": "blt x0, {0}, {1}",
    "bgt": "blt {1}, {0}, {2}",
    "ble": "bge {1}, {0}, {2}",
    "bgtu": "bltu {1}, {0}, {2}",
    "bleu": "bgeu {1}, {0}, {2}",
}
# format: the operands' fields in the text
ORDERS = {
    "R": ("rd", "rs1", "rs2"),
    "I": ("rd", "rs1", "imm"),
    "H": ("rd", "rs1", "imm"),
    "B": ("rs1", "rs2", "imm"),
    "U": ("rd", "imm"),
    "J": ("rd", "imm"),
    "C": ("rd", "imm"),
    "W": ("imm", "rs1"),
}
OFFSET = re.compile(r"(.*)\((\w+)\)$")


def _value(text: str, names: Mapping[str, int]) -> int:
    """Return the value of a number, a name or a sum of them. Raises ParameterError."""
    total = 0
    for sign, word in re.findall(r"([+-]?)\s*([\w.]+)", text):
        try:
            number = names[word] if word in names else int(word, 0)
        except ValueError:
            raise ParameterError(f"value = {text!r}: must be a number or a label") from None
        total += -number if sign == "-" else number
    return total


def _expanded(name: str, operands: list[str], names: Mapping[str, int], final: bool) -> list[tuple[str, list[str]]]:
    """Return the instructions of one of the text. final: all labels are known."""
    if name in PSEUDO:
        word, _, places = PSEUDO[name].format(*operands, *[""] * 3).partition(" ")
        return [(word, places.split(", ") if places else [])]
    if name not in ("li", "la"):
        return [(name, operands)]
    value = _value(operands[1], names) if final or name == "li" else 0
    if name == "li" and -2048 <= signed(value) < 2048:
        return [("addi", [operands[0], "x0", str(signed(value))])]
    low = signed(value, 12)
    upper = ("lui", [operands[0], str((value - low & MASK) >> 12)])
    return [upper, ("addi", [operands[0], operands[0], str(low)])] if low or name == "la" else [upper]


def _word(name: str, operands: list[str], pc: int, names: Mapping[str, int]) -> int:
    if name == "ebreak":
        return EBREAK
    if name not in TABLE:
        raise ParameterError(f"instruction = {name!r}: must be one of {', '.join([*TABLE, *PSEUDO, 'li', 'la'])}")
    form = TABLE[name][0]
    if name == "fence":
        return encode(name, imm=0xFF)  # all before all
    if (name in LOADS or name in STORES or name == "jalr") and (match := OFFSET.match(operands[-1])):
        operands = [operands[0], match[2], match[1] or "0"]
    order = ("rs2", "rs1", "imm") if form == "S" else ORDERS[form]
    if len(operands) != len(order):
        raise ParameterError(f"operands = {', '.join(operands)} of {name}: must be {', '.join(order)}")
    fields = {}
    for field, text in zip(order, operands, strict=True):
        if field != "imm":
            if text not in REGISTERS:
                raise ParameterError(f"register = {text!r}: must be x0..x31 or a name of the ABI")
            fields[field] = REGISTERS[text]
        else:
            relative = form in "BJ" and not re.match(r"[-+]?\d", text)
            fields[field] = _value(text, names) - (pc if relative else 0)
    return encode(name, **fields)


def assemble(text: str, **constants: int) -> bytes:
    """Return the program of ``text``; constants: names for it. Raises ParameterError with the line."""
    names: dict[str, int] = dict(constants)
    words: list[int] = []
    for final in (False, True):  # labels first
        words = []
        for number, line in enumerate(text.splitlines(), 1):
            try:
                line = line.partition("#")[0].strip()
                while match := re.match(r"(\w+):\s*", line):
                    names[match[1]] = 4 * len(words)
                    line = line[match.end() :]
                name, _, rest = line.partition(" ")
                operands = [operand.strip() for operand in rest.split(",")] if rest else []
                if name == ".equ":
                    names[operands[0]] = _value(operands[1], names)
                elif name == ".word":
                    words += [_value(operand, names) & MASK if final else 0 for operand in operands]
                elif name == ".zero":
                    words += [0] * (_value(rest, names) // 4)
                elif name:
                    for word, parts in _expanded(name, operands, names, final):
                        words.append(_word(word, parts, 4 * len(words), names) if final else 0)
            except (ParameterError, IndexError) as error:
                raise ParameterError(f"line {number}: {error}") from None
    return b"".join(word.to_bytes(4, "little") for word in words)
