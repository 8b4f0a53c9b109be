"""The signatures of riscv-arch-test on Proc: every instruction of RV32I.

RISCV_ARCH_TEST: a checkout of github.com/riscv-non-isa/riscv-arch-test. Up to 2.7.4 (branch old-framework-2.x) it has
reference signatures; where it has none, tinyrv's signature is the reference.
"""

import os
import subprocess
from pathlib import Path

import pytest

from talbot.rtl.proc import Proc, ProcCL
from talbot.rtl.proc.golden import Memory, run
from talbot.rtl.proc.isa import TABLE
from talbot.rtl.proc.test.proc_bench import ALWAYS, Bench

pytestmark = pytest.mark.needs("RISCV_ARCH_TEST", "riscv64-unknown-elf-gcc")
PREFIX = "riscv64-unknown-elf-"
INSTRUCTIONS = sorted(TABLE.keys() - {"csrr", "csrw"})
LIMIT = 1_000_000  # instructions
IO = "INIT WRITE_STR(_SP,_STR) CHECK() ASSERT_GPR_EQ(_S,_R,_I) ASSERT_SFPR_EQ(_F,_R,_I) ASSERT_DFPR_EQ(_D,_R,_I)"
MODEL = """
#define ALIGNMENT 2
#define RVMODEL_BOOT
#define RVMODEL_HALT ebreak
#define RVMODEL_DATA_BEGIN .align 4; .global begin_signature; begin_signature:
#define RVMODEL_DATA_END .align 4; .global end_signature; end_signature:
""" + "".join(f"#define RVMODEL_IO_{macro}\n" for macro in IO.split())
SCRIPT = "ENTRY(rvtest_entry_point) SECTIONS { . = 0; .text : { *(.text.init) *(.text) } .data : { *(.data*) } }"


def compiled(name: str, folder: Path) -> tuple[bytes, range]:
    """Return the program of the suite's test of instruction ``name``, and the addresses of its signature's words."""
    suite = Path(os.environ["RISCV_ARCH_TEST"]) / "riscv-test-suite"
    source = next((suite / "rv32i_m" / "I" / "src").glob(f"{name}-*01.S"))
    (folder / "model_test.h").write_text(MODEL)
    (folder / "link.ld").write_text(SCRIPT)
    elf, program = folder / "test.elf", folder / "test.bin"
    options = (
        "-march=rv32i_zicsr -mabi=ilp32 -nostdlib -nostartfiles -static -DXLEN=32 -DFLEN=0 -DTEST_CASE_1=True".split()
    )
    options += ["-I", str(folder), "-I", str(suite / "env"), "-T", str(folder / "link.ld"), "-o", str(elf), str(source)]
    subprocess.run([f"{PREFIX}gcc", *options], check=True)
    subprocess.run([f"{PREFIX}objcopy", "-O", "binary", elf, program], check=True)
    lines = subprocess.run([f"{PREFIX}nm", elf], check=True, capture_output=True, text=True).stdout.splitlines()
    places = {symbol: int(address, 16) for address, _, symbol in map(str.split, lines)}
    return program.read_bytes(), range(places["begin_signature"], places["end_signature"], 4)


def reference(name: str, program: bytes, places: range, require) -> list[int]:
    """Return the suite's reference signature, or tinyrv's."""
    folder = Path(os.environ["RISCV_ARCH_TEST"]) / "riscv-test-suite" / "rv32i_m" / "I" / "references"
    for file in folder.glob(f"{name}-*01.reference_output"):
        return [int(line, 16) for line in file.read_text().split()]
    require("tinyrv")
    import tinyrv

    other = tinyrv.sim(xlen=32)
    other.copy_in(0, program)
    for _ in run(program, limit=LIMIT).pcs[:-1]:
        other.step(trace=False)
    words = bytes(other.copy_out(places.start, len(places) * 4))
    return [int.from_bytes(words[n : n + 4], "little") for n in range(0, len(words), 4)]


def signature(memory: Memory, places: range) -> list[int]:
    return [memory.words.get(address, 0) for address in places]


@pytest.mark.parametrize("name", INSTRUCTIONS)
def test_golden(name, tmp_path, require):
    program, places = compiled(name, tmp_path)
    golden = run(program, limit=LIMIT)
    assert golden.stopped
    assert signature(golden.memory, places) == reference(name, program, places, require)


class TestCL:
    cls, verilog = ProcCL, False

    @pytest.mark.parametrize("name", INSTRUCTIONS)
    def test_signature(self, name, tmp_path, require):
        program, places = compiled(name, tmp_path)
        bench = Bench(type(self).cls, self.verilog)
        for willing, latencies in ((ALWAYS, (1,)), ((True, False, True, True, False), (1, 3, 2, 1))):
            assert bench.run(program, (), willing, latencies, limit=LIMIT)
            assert signature(bench.memory, places) == reference(name, program, places, require)


class TestVerilog(TestCL):
    cls, verilog = Proc, True
