"""Programs of test chip 1: assembly by the project's assembler, C by GNU's compiler."""

import tempfile
from pathlib import Path

from talbot.base.tools import run
from talbot.rtl.proc.assembler import assemble

FOLDER = Path(__file__).parent
TOOL = "riscv64-unknown-elf"
JOB = 0x9C0  # address of a program's parameters and results; in C the stack ends there
OPTIONS = "-march=rv32i_zicsr -mabi=ilp32 -O1 -Wall -Werror -ffreestanding -fno-reorder-functions -nostdlib -static"
LINKED = f"-Wl,--build-id=none,-Ttext=0,-N,-e,0,--no-warn-rwx-segments,--defsym=job={JOB}"


def assembled(name: str, **constants: int) -> bytes:
    """Return the program in ``name``.s. constants: names for it. Raises ParameterError."""
    return assemble((FOLDER / f"{name}.s").read_text(encoding="utf-8"), **constants)


def compiled(name: str) -> bytes:
    """Return the program in ``name``.c. Raises ToolError without the compiler."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        linked, image = Path(folder) / "program.elf", Path(folder) / "program.bin"
        sources = "-x", "assembler", FOLDER / "start.s", "-x", "c", FOLDER / f"{name}.c", "-x", "none", "-lgcc"
        run([f"{TOOL}-gcc", *OPTIONS.split(), LINKED, *sources, "-o", linked])
        run([f"{TOOL}-objcopy", "-O", "binary", linked, image])
        return image.read_bytes()
