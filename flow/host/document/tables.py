"""The tables that `talbot document` writes between the marks of docs/host.md: pins, tile, worked examples."""

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
from .pins import host_pins

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
    """Return the table of the pixel type at each position of a tile."""
    tile = SENSOR.tile
    rows = ([f"**{r}**", *tile.order[tile.cols * r : tile.cols * (r + 1)]] for r in range(tile.rows))
    return table(["row in tile \\ k", *map(str, range(tile.cols))], rows)


def pixel_types() -> str:
    """Return the table of beta, gamma and alpha, a row for all types of the same beta and gamma."""
    gratings: dict[tuple[float, float], dict[int, float]] = {}
    for t, p in enumerate(SENSOR.tile.types):
        gratings.setdefault((p.beta, p.gamma_deg), {})[t] = math.degrees(p.alpha)
    rows = (
        (", ".join(map(str, alphas)), f"{beta:g}", f"{gamma:g}", ", ".join(f"{alpha:g}" for alpha in alphas.values()))
        for (beta, gamma), alphas in gratings.items()
    )
    return table(["types", "beta", "gamma, degrees", "alpha, degrees"], rows)


def phase_examples() -> str:
    """Return the table of taps, their differences, and the phase and amplitude that the chip sends."""
    taps = [(100, 100, 100, 200), (200, 100, 0, 10), (255, 0, 0, 255), (90, 91, 90, 89), (7, 7, 7, 7)]
    sent = zip(*phase_samples(np.array(taps), SENSOR.chip, noise_floor=8))
    rows = ((*four, four[0] - four[2], four[3] - four[1], *pair) for four, pair in zip(taps, sent))
    return table(["i0", "i90", "i180", "i270", "x", "y", "phase sent", "amplitude sent"], rows)


def pattern_examples() -> str:
    """Return the table of test pattern values at a few positions."""
    places = [(0, 0, 5, 0), (0, 1, 0, 0), (4, 0, 0, 0), (4, 2, 3, 0), (100, 63, 5, 3), (383, 63, 5, 0)]
    return table(["row", "tile", "k", "sub", "value"], ((*p, int(pattern_value(*p))) for p in places))


def session() -> str:
    """Return every byte of a short frame of the default chip, on SPI and on the link."""
    chip = register_map()
    resets = chip.image(chip.configuration)
    values = chip.image(chip.configuration, frame_values(EXAMPLE))
    stream = golden_frame(np.zeros(0), SENSOR, EXAMPLE, PatternEnd(SENSOR.array.rows, SENSOR.array.cols)).stream
    done = 1 << chip["done"].shift
    lines = ["SPI, one transfer a line: mosi -> miso"]
    for text, sent, answer in (
        ("identity", read_transfer(chip["id"].byte, 2), bytes((0, chip["id"].reset, chip["version"].reset))),
        *(
            ("configuration", transfer, b"")
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
    "tile": tile_order,
    "pixel types": pixel_types,
    "phase examples": phase_examples,
    "pattern examples": pattern_examples,
    "session": session,
}
