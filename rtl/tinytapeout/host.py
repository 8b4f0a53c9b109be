"""A microcontroller at a project's pins: programs for host.v, which runs in Icarus; its comment lists the words."""

from collections.abc import Iterable, Sequence
from itertools import chain
from pathlib import Path

from talbot.base.tools import run
from talbot.models.parameters import AmpTiming
from talbot.rtl.harness.icarus import compile_program

BENCH = Path(__file__).with_name("host.v")
ADDRESS, WAIT, SHOW, ROW, END = 0x100, 0x300, 0x400, 0x500, 0x600
START, RESULTS = 3, 4  # of the divider: the address that starts a division, bytes of its result
HOLD_FREE = 0x201
SCLK, CSN, MOSI, LINK_RDY = 1, 2, 4, 8  # of the chip, bits of ui_in
SHOWN = 255 * 256  # cycles that a program shows at once, at most
DURATIONS = "t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard"  # of the amplifier control, 16 bits each


def divisions(requests: Iterable[tuple[int, int, int]]) -> list[int]:
    """Return the program for the divider: it shows the four bytes of each result of (x, y, noise floor / 4)."""
    words = []
    for x, y, floor in requests:
        high = floor << 2 | (y >> 8 & 1) << 1 | x >> 8 & 1
        words += [ADDRESS, x & 255, y & 255, high, 0, WAIT]
        for address in range(RESULTS):
            words += [ADDRESS | address, SHOW]
    return words


def row(timing: AmpTiming, four_tap: bool, cycles: int) -> list[int]:
    """Return the program for the amplifier control: one row, shown for at least ``cycles``."""
    durations = [getattr(timing, name) for name in DURATIONS]
    data = [byte for value in durations for byte in (value & 255, value >> 8)] + [timing.n_cm]
    return [HOLD_FREE, ADDRESS, *data, ROW | cycles // 256 + 1, int(four_tap)]


def frame(transfers: Sequence[bytes], cycles: int = SHOWN) -> list[int]:
    """Return the program for the chip: SPI ``transfers``, the last one and at least ``cycles`` shown."""
    *before, last = map(_bits, transfers)
    return [CSN | LINK_RDY, *chain.from_iterable(before), ROW | -(-cycles // 256), *last]


def _bits(transfer: bytes) -> list[int]:
    """Return the program for an SPI transfer to the chip."""
    bits = (byte >> bit & 1 for byte in transfer for bit in range(7, -1, -1))
    levels = [level for bit in bits for level in (LINK_RDY | MOSI * bit, LINK_RDY | MOSI * bit | SCLK)]
    return [LINK_RDY, *levels, LINK_RDY, CSN | LINK_RDY]


def simulate(
    top: str, words: Sequence[int], sources: Sequence[Path], folder: Path, more: str = "", options: Sequence[str] = ()
) -> list[str]:
    """Run the program ``words`` on module ``top`` of the Verilog files ``sources``; returns the lines that it shows.

    folder: of the files that Icarus reads. more: further Verilog with a module Tap. options: of the
    simulation. Raises IcarusError, ToolError.
    """
    program = folder / "host.hex"
    program.write_text("\n".join(f"{word:03x}" for word in [*words, END]) + "\n", encoding="utf-8")
    texts = [f"`define TOP {top}\n{BENCH.read_text(encoding='utf-8')}", *filter(None, [more])]
    compile_program(folder / "host.vvp", sources, "host", texts, *(("Tap",) if more else ()))
    lines = run(["vvp", "-n", folder / "host.vvp", f"+program={program}", *options]).splitlines()
    return [line for line in lines if line and line[0] in "01xzte"]
