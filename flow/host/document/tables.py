"""What `talbot document` writes between the marks of docs/host.md: pins, tile, worked examples."""

import math
from collections.abc import Callable

import numpy as np

from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, frame_values, read_transfer, write_transfers
from talbot.models.digital.pattern import PatternEnd, pattern_value
from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import AmpTiming, FrameParameters, SensorParameters, Window
from talbot.models.parameters.registers import register_map

from .markdown import table
from .pins import analog_pins, host_pins

SENSOR = SensorParameters()
# A short frame that the default chip sends with nothing connected to its analog pins
EXAMPLE = FrameParameters(
    Window(1, 1, 0, 2),
    "edge",
    mask=0x00FF,
    threshold=4,
    test_pattern=True,
    frame_number=0x1234,
    timing=AmpTiming(t_int=1),
)


def tile_order() -> str:
    """Pixel type at each position of a tile."""
    tile = SENSOR.tile
    rows = ([f"**{r}**", *tile.order[tile.cols * r : tile.cols * (r + 1)]] for r in range(tile.rows))
    return table(["row in tile \\ k", *map(str, range(tile.cols))], rows)


def pixel_types() -> str:
    """Angular frequency, direction and phase of each pixel type."""
    rows = (
        (t, f"{p.beta:g}", f"{p.gamma_deg:g}", f"{math.degrees(p.alpha):g}") for t, p in enumerate(SENSOR.tile.types)
    )
    return table(["type", "beta", "gamma, degrees", "alpha, degrees"], rows)


def phase_examples() -> str:
    """Taps, and what the chip sends for them."""
    taps = [(200, 100, 100, 100), (100, 100, 100, 200), (100, 100, 200, 100), (100, 200, 100, 100), (200, 100, 0, 10)]
    taps += [(255, 0, 0, 255), (90, 91, 90, 89), (7, 7, 7, 7)]
    sent = zip(*phase_samples(np.array(taps), SENSOR.chip, noise_floor=8))
    rows = ((*four, four[0] - four[2], four[3] - four[1], *pair) for four, pair in zip(taps, sent))
    return table(["i0", "i90", "i180", "i270", "x", "y", "phase sent", "amplitude sent"], rows)


def pattern_examples() -> str:
    """Values of the test pattern."""
    places = [(0, 0, 0, 0), (0, 0, 5, 0), (0, 1, 0, 0), (0, 2, 0, 0), (4, 0, 0, 0), (4, 2, 3, 0), (0, 0, 0, 1)]
    places += [(100, 63, 5, 3), (383, 63, 5, 0)]
    return table(["row", "tile", "k", "sub", "value"], ((*p, int(pattern_value(*p))) for p in places))


def session() -> str:
    """Every byte of a short frame of the default chip, on SPI and on the link."""
    chip = register_map()
    resets = chip.image(chip.configuration)
    values = chip.image(chip.configuration, frame_values(EXAMPLE))
    stream = golden_frame(np.zeros(0), SENSOR, EXAMPLE, PatternEnd(SENSOR.array.rows, SENSOR.array.cols)).stream
    done = 1 << chip["done"].shift
    lines = ["SPI, a transfer a line: out, and what comes in where it matters"]
    for text, sent, answer in (
        ("identity", read_transfer(chip["id"].byte, 2), bytes((0, chip["id"].reset, chip["version"].reset))),
        *(
            ("configuration, bytes that differ from the reset", transfer, b"")
            for transfer in write_transfers(sorted(set(values.items()) - set(resets.items())))
        ),
        ("start", command("start"), b""),
        ("status: done", read_transfer(chip["busy"].byte, 1), bytes((0, done))),
    ):
        lines.append(f"  {sent.hex(' '):<12} {'-> ' + answer.hex(' ') if answer else '':<12} {text}".rstrip())
    lines += ["", "link"] + [f"  {stream[i : i + 26].hex(' ')}" for i in range(0, len(stream), 26)]
    return "\n".join(["```", *lines, "```"])


TABLES: dict[str, Callable[[], str]] = {
    "host pins": host_pins,
    "analog pins": analog_pins,
    "tile": tile_order,
    "pixel types": pixel_types,
    "phase examples": phase_examples,
    "pattern examples": pattern_examples,
    "session": session,
}
