"""The chip's pins as a host sees them: direction and width from the top's ports, meaning from here."""

from collections.abc import Iterator

from talbot.rtl.asp_chip.pins import pins

from .markdown import table

HOST = {  # the pins of the digital side
    "clk": "System clock. All pins except SPI's are synchronous to its rising edge.",
    "reset": "Active high, synchronized on the chip; at least 4 rising edges of `clk`.",
    "sclk": "SPI clock, mode 0, at most f_clk / 8.",
    "csn": "SPI chip select, active low.",
    "mosi": "SPI data to the chip, most significant bit first.",
    "miso": "SPI data from the chip; 0 while `csn` is high.",
    "miso_oe": "Output enable of a shared `miso` pad: `csn` is low, and no reset.",
    "link_data": "A byte of the stream.",
    "link_val": "`link_data` is valid. The byte stays until it is taken (or abort, or reset).",
    "link_rdy": "The receiver takes `link_data` at the next rising edge of `clk`.",
    "frame_sync": "High from the offer of a frame's first byte until its last is taken; low in loop-back.",
    "busy": "A frame runs, or its bytes wait for the link. Falls with `done` or an error bit: the host's interrupt.",
}
ANALOG = {  # to and from the array, the amplifiers and the converters; a host leaves them alone
    "comparator": "Each lane: the held value is at or above the level of its `dac`.",
    "dac": "Code of each lane, lane 0 lowest; offset binary unless `unsigned_`.",
    "hold": "The lanes in `en` sample at the end of this cycle.",
    "unsigned_": "Range of the converters: codes 0..255; low: -128..127.",
    "mode": "The readout mode, as in the register.",
    "row": "Pixel row at the converters.",
    "group": "Tile columns L * group .. L * group + L - 1 at the converters.",
    "k": "Column in the tile at the converters.",
    "sub": "Sub-sample: raw 0 diode a, 1 diode b; tof the tap 0..3.",
    "en": "Lanes that convert.",
    "balance": "Trim of the pixel type at the converters, signed; valid with `hold`.",
    "pixel_reset": "Amplifier phase: reset of the pixels of row `reset_row`.",
    "shutter": "From the first integration to the end of the last.",
    "ref_ctl": "With `read`: the reference level, then the signal.",
    "integrate": "Amplifier phase: row `amp_row` integrates.",
    "expose": "One cycle: row `reset_row` integrates from here until `integrate` of the slot that reads it ends.",
    "cm_reset": "Amplifier phase: common-mode reset.",
    "read": "Amplifier phase: read.",
    "sample": "Last cycle of each half of `read`.",
    "tap": "Time-of-flight tap, for the modulation generator.",
    "amp_row": "Row of the amplifier phases except `pixel_reset`.",
    "reset_row": "Row of `pixel_reset` and `expose`: `exposure` rows ahead of `amp_row`.",
}


def host_pins() -> str:
    """Table of the pins that a host or a board drives or reads."""
    return _table(HOST)


def analog_pins() -> str:
    """Table of the other pins."""
    return _table(ANALOG)


def _table(meaning: dict[str, str]) -> str:
    widths = {name: (direction, width) for direction, name, width in _ports()}
    if unknown := set(widths) ^ {*HOST, *ANALOG}:
        raise KeyError(f"pins {sorted(unknown)}: a port without a meaning here, or the reverse")
    rows = ((f"`{name}`", *widths[name], text) for name, text in meaning.items())
    return table(["pin", "direction", "bits", "meaning"], rows)


def _ports() -> Iterator[tuple[str, str, str]]:
    """(direction, name, width), the width in lanes L where it depends on them."""
    yield from (("in", name, "1") for name in ("clk", "reset"))
    for direction, one, two in zip(("in", "out"), pins(1), pins(2)):
        for name, kind in one.items():
            by_lane = two[name].nbits - kind.nbits
            yield direction, name, f"{by_lane if by_lane > 1 else ''} L".strip() if by_lane else str(kind.nbits)
