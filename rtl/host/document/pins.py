"""The pins that a host drives or reads: direction and width from the top's ports, meaning from here."""

from collections.abc import Iterator

from talbot.rtl.asp_chip.pins import pins

MEANING = {
    "clk": "clock; all pins except SPI's and `reset` are synchronous to its rising edge",
    "reset": "active high, synchronized on the chip; at least 4 rising edges of `clk`",
    "sclk": "SPI clock, mode 0, at most f_clk / 8",
    "csn": "SPI chip select, active low",
    "mosi": "SPI data to the chip, most significant bit first",
    "miso": "SPI data from the chip; 0 while `csn` is high",
    "miso_oe": "output enable of a shared `miso` pad: `csn` is low, and no reset",
    "link_data": "a byte of the stream",
    "link_val": "`link_data` is valid, and stays until it is taken (or abort, or reset)",
    "link_rdy": "the receiver takes `link_data` at the next rising edge of `clk`",
    "frame_sync": "high from the offer of a frame's first byte until its last is taken; low in loop-back",
    "busy": "a frame runs, or its bytes wait for the link; falls with `done` or an error bit: the host's interrupt",
}


def host_pins() -> str:
    """Return the list of the pins that a host or a board drives or reads. Raises KeyError for one that is no port."""
    ports = {name: (direction, bits) for direction, name, bits in _ports()}
    rows = ((pin, *ports[pin], text) for pin, text in MEANING.items())
    return "\n".join(
        f"- `{pin}[{bits}]`, {direction}: {text}" if bits > 1 else f"- `{pin}`, {direction}: {text}"
        for pin, direction, bits, text in rows
    )


def _ports() -> Iterator[tuple[str, str, int]]:
    """Yield direction, name and width of every port of the host's side."""
    yield from (("in", name, 1) for name in ("clk", "reset"))
    for direction, ports in zip(("in", "out"), pins(1)):
        yield from ((direction, name, kind.nbits) for name, kind in ports.items())
