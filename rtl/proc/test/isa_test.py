"""The golden simulator and the assembler, against each other, tinyrv, and GNU's assembler where they are installed."""

import subprocess

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from talbot.models.parameters import ParameterError
from talbot.rtl.proc.assembler import REGISTERS, assemble
from talbot.rtl.proc.golden import run
from talbot.rtl.proc.isa import MASK, RANGES, READABLE, TABLE, WRITABLE, Instruction, decode, encode
from talbot.rtl.proc.test.programs import DUMP, program
from talbot.rtl.proc.test.programs import ITEMS as EVERY_ITEM

SETTINGS = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
ITEMS = EVERY_ITEM.filter(lambda item: isinstance(item, tuple) or item[-1] & 0x7F != 0x73)  # no CSRs: tinyrv lacks ours
FIELDS = {"R": "rd rs1 rs2", "I": "rd rs1 imm", "H": "rd rs1 imm", "S": "rs1 rs2 imm", "B": "rs1 rs2 imm"}
FIELDS |= {"U": "rd imm", "J": "rd imm", "C": "rd imm", "W": "rs1 imm"}


@st.composite
def instructions(draw):
    name = draw(st.sampled_from(sorted(TABLE.keys() - {"fence"})))
    form = TABLE[name][0]
    least, largest, step = RANGES[form]
    imm = st.integers(least // step, largest // step).map(lambda n: n * step)
    imm = {"C": st.sampled_from(READABLE), "W": st.sampled_from(WRITABLE)}.get(form, imm)
    return name, {field: draw(imm if field == "imm" else st.integers(0, 31)) for field in FIELDS[form].split()}


@settings(max_examples=400, deadline=None)
@given(instructions())
def test_decode_inverts_encode(instruction):
    name, fields = instruction
    word = encode(name, **fields)
    imm = fields.get("imm", 0)
    assert decode(word) == Instruction(name, **fields | {"imm": imm << 12 if TABLE[name][0] == "U" else imm})


@pytest.mark.needs("tinyrv")
@SETTINGS
@given(st.lists(ITEMS, max_size=40))
def test_golden_equals_tinyrv(items):
    import tinyrv

    code = program(items)
    golden, other = run(code, limit=2000), tinyrv.sim(xlen=32)
    other.copy_in(0, code)
    for pc in golden.pcs[: -1 if golden.stopped else None]:
        assert other.pc == pc
        other.step(trace=False)
    if golden.stopped:
        assert other.pc == golden.pcs[-1]
        assert golden.registers == [other.x[n] & MASK for n in range(32)]
        stored = [golden.memory.words[DUMP + 4 * n] for n in range(32)]
        assert bytes(other.copy_out(DUMP, 128)) == b"".join(word.to_bytes(4, "little") for word in stored)


TEXT = """
start: li a0, 0x12345678
li a1, -5
li a2, 0x7ff000
back: add x3, s0, t6
sub a0, a1, a2
sltiu t0, t1, -1
srai t2, t3, 31
lw ra, -4(sp)
sb gp, 2047(tp)
jalr x0, 8(a5)
beq a0, a1, back
bgt a0, a1, forward
jal ra, start
lui a7, 0xfffff
auipc a7, 1
csrr a0, 0xf14
csrw 0x7c0, a0
fence
seqz a0, a1
snez a0, a1
neg a0, a1
not a0, a1
forward: bltz s11, back
j forward
ret
ebreak
"""


@pytest.mark.needs("riscv64-unknown-elf-gcc")
def test_the_assembler_equals_gnus(tmp_path):
    tools = [f"riscv64-unknown-elf-{name}" for name in ("as", "objcopy")]
    (tmp_path / "a.s").write_text(".option norelax\n" + TEXT)
    options = ["-march=rv32i_zicsr", "-mabi=ilp32", "-o", tmp_path / "a.o", tmp_path / "a.s"]
    subprocess.run([tools[0], *options], check=True)
    subprocess.run([tools[1], "-O", "binary", "-j", ".text", tmp_path / "a.o", tmp_path / "a.bin"], check=True)
    assert assemble(TEXT) == (tmp_path / "a.bin").read_bytes()


@pytest.mark.parametrize(
    "text, message",
    [
        ("nop\nadd x1, x2", "line 2: operands = x1, x2 of add: must be rd, rs1, rs2"),
        ("addi x1, x2, 2048", "line 1: imm = 2048 of addi: must be -2048..2047"),
        ("add x1, x2, x32", "line 1: register = 'x32': must be"),
        ("mul x1, x2, x3", "line 1: instruction = 'mul': must be one of"),
        ("beq x1, x2, nowhere", "line 1: value = 'nowhere': must be"),
        ("beq x1, x2, 3", "line 1: imm = 3 of beq: must be -4096..4094, a multiple of 2"),
    ],
)
def test_refuses(text, message):
    with pytest.raises(ParameterError, match=message):
        assemble(text)


def test_encode_refuses():
    with pytest.raises(ParameterError, match="rd = 32: must be 0..31"):
        encode("add", 32)


def test_names_of_registers():
    assert sorted(set(REGISTERS.values())) == list(range(32)) and REGISTERS["t6"] == 31 and REGISTERS["a0"] == 10
