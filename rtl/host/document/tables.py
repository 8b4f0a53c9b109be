"""The tables that `talbot document` writes between the marks of docs/host.md: pins, tile, worked examples."""

import math
from collections.abc import Callable, Iterable
from textwrap import fill

import numpy as np

from talbot.base.table import markdown_table
from talbot.models.chip import golden_frame
from talbot.models.digital.host import command, frame_values, read_transfer, write_transfers
from talbot.models.digital.pattern import PatternEnd, pattern_value
from talbot.models.digital.phase import phase_samples
from talbot.models.parameters import AmpTiming, FrameParameters, SensorParameters, Window
from talbot.models.parameters.registers import RegisterMap, array_resets, register_map
from talbot.rtl.host.document.pins import host_pins


def block(head: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """Return a code block of right-aligned columns."""
    lines = [[str(cell) for cell in row] for row in (head, *rows)]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "\n".join(["```", *("  ".join(map(str.rjust, line, widths)) for line in lines), "```"])


def example(sensor: SensorParameters) -> FrameParameters:
    """Return a short frame that a chip sends with nothing connected to its analog pins."""
    last = sensor.full_window
    return FrameParameters(
        Window(min(1, last.row1), min(1, last.row1), 0, min(2, last.col1)),
        "edge",
        mask=0x00FF,
        threshold=4,
        test_pattern=True,
        frame_number=0x1234,
        timing=AmpTiming(t_int=1),
    )


def chip_sizes(sensor: SensorParameters) -> str:
    """Return a paragraph on the chip's sizes."""
    array, tile, lanes = sensor.array, sensor.tile, sensor.chip.lanes
    rows, cols = (
        f"{size} {place} .. {size} {place} + {size - 1}" for size, place in ((tile.rows, "T"), (tile.cols, "t"))
    )
    text = (
        f"The chip of this document has {array.rows} x {array.cols} pixels and {lanes} lane{'s' * (lanes > 1)}. A "
        f"*tile* is {tile.rows} x {tile.cols} pixels, one of each of the {tile.n_types} *pixel types*; tile (T, t) "
        f"has the rows {rows} and the columns {cols}."
    )
    return fill(text, 120)


def resets_of(sensor: SensorParameters) -> dict[str, int]:
    """Return the values after reset that follow the sensor, by field."""
    array, tile, chip = sensor.array, sensor.tile, sensor.chip
    return array_resets(array.rows, array.cols, chip.lanes, tile.rows, tile.cols, chip.divider)


def map_of(sensor: SensorParameters) -> RegisterMap:
    """Return the register map of the sensor's chip."""
    return register_map().with_resets(resets_of(sensor))


def tile_order(sensor: SensorParameters) -> str:
    """Return the table of the pixel type at each position of a tile."""
    tile = sensor.tile
    rows = ([f"row {r}", *tile.order[tile.cols * r : tile.cols * (r + 1)]] for r in range(tile.rows))
    return block(["k", *range(tile.cols)], rows)


def pixel_types(sensor: SensorParameters) -> str:
    """Return the table of beta, gamma and alpha, a row for all types of the same beta and alphas."""
    gratings: dict[tuple[float, float], dict[int, float]] = {}
    for t, p in enumerate(sensor.tile.types):
        gratings.setdefault((p.beta, p.gamma_deg), {})[t] = math.degrees(p.alpha)
    rows: dict[tuple[float, str], dict[float, str]] = {}
    for (beta, gamma), alphas in gratings.items():
        same = rows.setdefault((beta, ", ".join(f"{alpha:g}" for alpha in alphas.values())), {})
        same[gamma] = ", ".join(map(str, alphas))
    cells = (
        ("; ".join(types.values()), f"{beta:g}", "; ".join(f"{gamma:g}" for gamma in types), alphas)
        for (beta, alphas), types in rows.items()
    )
    return markdown_table(["types", "beta", "gamma, degrees", "alpha, degrees"], cells)


def phase_examples(sensor: SensorParameters) -> str:
    """Return the table of taps, and of the phase and amplitude that the chip sends."""
    if not sensor.chip.has_phase_path:
        return "This chip has no phase path: `phase` has no effect."
    taps = [(100, 100, 100, 200), (200, 100, 0, 10), (90, 91, 90, 89)]
    sent = zip(*phase_samples(np.array(taps), sensor.chip, noise_floor=8))
    rows = ((*four, *pair) for four, pair in zip(taps, sent))
    return block(["i0", "i90", "i180", "i270", "phase", "amplitude"], rows)


def pattern_examples(sensor: SensorParameters) -> str:
    """Return the table of test pattern values at a few positions that the array has, and at its last pixel."""
    array, tile = sensor.array, sensor.tile
    places = [(0, 0, 5, 0), (4, 0, 0, 0), (100, 63, 5, 3)]
    places = [p for p in places if p[0] < array.rows and p[1] * tile.cols + p[2] < array.cols and p[2] < tile.cols]
    places += [(array.rows - 1, *divmod(array.cols - 1, tile.cols), 0)]
    return block(["row", "tile", "k", "sub", "value"], ((*p, int(pattern_value(*p))) for p in places))


def session(sensor: SensorParameters) -> str:
    """Return every byte of a short frame of the chip, on SPI and on the link."""
    chip, frame = map_of(sensor), example(sensor)
    resets = chip.image(chip.configuration)
    values = chip.image(chip.configuration, frame_values(frame))
    end = PatternEnd(sensor.array.rows, sensor.array.cols, sensor.tile)
    stream = golden_frame(np.zeros(0), sensor, frame, end).stream
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


TABLES: dict[str, Callable[[SensorParameters], str]] = {
    "chip": chip_sizes,
    "host pins": lambda _: host_pins(),  # the same for every sensor
    "tile": tile_order,
    "pixel types": pixel_types,
    "phase examples": phase_examples,
    "pattern examples": pattern_examples,
    "session": session,
}
