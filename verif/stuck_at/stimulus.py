"""The functional test: a tester's inputs at the chip's pins, cycle by cycle, independent of the outputs."""

import numpy as np
import numpy.typing as npt

from talbot.models.digital.host import command, frame_writes, read_transfer, write_transfers
from talbot.models.parameters import MODES, SHORT_TIMING, FrameParameters, SensorParameters
from talbot.models.parameters.registers import register_map

HALF_BIT = 4  # cycles, at the fastest clock of SPI
RESET = 8
FRAME_CYCLES = 3000  # after which a frame of the test has ended
INPUTS = ("reset", "sclk", "csn", "mosi", "link_rdy", "comparator")
CHIP = register_map()
TRIMS = [(-1) ** t * (20 * t + 3) for t in range(24)]


class Tester:
    """Drives the inputs of INPUTS; ``cycles`` has a line for each cycle, without link_rdy and comparator."""

    def __init__(self) -> None:
        self.cycles: list[tuple[int, int, int, int]] = [(1, 0, 1, 0)] * RESET

    def wait(self, cycles: int) -> None:
        """Wait for some cycles."""
        self.cycles += [(0, 0, 1, 0)] * cycles

    def transfer(self, octets: bytes) -> None:
        """Send an SPI transfer."""
        self.cycles += [(0, 0, 0, octets[0] >> 7)] * HALF_BIT
        for octet in octets:
            for place in range(7, -1, -1):
                bit = octet >> place & 1
                self.cycles += [(0, 0, 0, bit)] * HALF_BIT + [(0, 1, 0, bit)] * HALF_BIT
        self.cycles += [(0, 0, 0, 0)] * HALF_BIT
        self.wait(2 * HALF_BIT)

    def read_all(self) -> None:
        """Read every address."""
        self.transfer(read_transfer(0, 127))

    def frame(self, frame: FrameParameters) -> None:
        """Configure and start a frame, wait for its end, read the status and the counters, clear the sticky bits."""
        for transfer in write_transfers(frame_writes(frame, TRIMS)):
            self.transfer(transfer)
        self.transfer(command("start"))
        self.wait(FRAME_CYCLES)
        counters = CHIP.counters
        self.transfer(read_transfer(CHIP["busy"].byte, 1))
        self.transfer(read_transfer(counters[0].byte, 8 * len(counters)))


def frames(sensor: SensorParameters) -> list[FrameParameters]:
    """Return a frame of the test pattern in each mode."""
    settings = [
        FrameParameters(
            sensor.full_window, mode, test_pattern=True, timing=SHORT_TIMING, threshold=9 * n, frame_number=0x5A5A >> n
        )
        for n, mode in enumerate(MODES)
    ]
    return [
        *settings,
        FrameParameters(sensor.full_window, "tof", test_pattern=True, timing=SHORT_TIMING, phase=True, noise_floor=20),
    ]


def functional_test(sensor: SensorParameters, seed: int) -> dict[str, npt.NDArray[np.int64]]:
    """Return the inputs of the whole test by name, a value a cycle."""
    tester, rng = Tester(), np.random.default_rng(seed)
    first, last = (end(CHIP.writable()) for end in (min, max))
    tester.read_all()
    for pattern in (b"\xaa\x55", b"\x55\xaa"):
        tester.transfer(bytes((0x80 | first,)) + (pattern * 64)[: last - first + 1])
        tester.read_all()
    for frame in frames(sensor):
        tester.frame(frame)
    tester.transfer(command("start"))
    tester.wait(100)
    tester.transfer(command("abort"))
    tester.transfer(bytes((0x80 | CHIP["loop_enable"].byte, 1 << CHIP["loop_enable"].shift)))
    tester.transfer(bytes((0x80 | CHIP["loop_back"].byte, *b"\xaa\x55\x0f\xf0")))
    tester.transfer(bytes((0x80 | CHIP["busy"].byte, 0xFF)))
    tester.read_all()
    cycles = np.array(tester.cycles, np.int64).T
    ready = rng.random(len(tester.cycles)) < 0.8
    comparator = rng.integers(0, 1 << sensor.chip.lanes, len(tester.cycles))
    return dict(zip(INPUTS, (*cycles, ready.astype(np.int64), comparator), strict=True))


def bits(gates_inputs: dict[str, list[int]], values: dict[str, npt.NDArray[np.int64]]) -> npt.NDArray[np.bool_]:
    """Return the values as bits (cycles, input bits), in the order of the netlist's inputs without clk."""
    columns = [
        values[name] >> place & 1 for name, nets in gates_inputs.items() if name != "clk" for place in range(len(nets))
    ]
    return np.array(columns, np.bool_).T
