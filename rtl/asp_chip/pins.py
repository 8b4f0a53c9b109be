"""The chip's pins, the same at every level (README.md)."""

from pymtl3 import Bits1, Bits2, Bits3, Bits8, Bits10, InPort, OutPort, mk_bits

from talbot.models.parameters.registers import register_map

INPUTS = ("sclk", "csn", "mosi", "link_rdy")
ORDER = "sclk", "csn", "mosi", "miso", "miso_oe", "link_data", "link_val", "link_rdy", "frame_sync", "busy"


def pins(lanes: int) -> tuple[dict[str, type], dict[str, type]]:
    """Return the types of inputs and outputs by name, without clk and reset. lanes: converters."""
    inputs = {**dict.fromkeys(INPUTS, Bits1), "comparator": mk_bits(lanes)}
    outputs = {
        "miso": Bits1,
        "miso_oe": Bits1,
        "link_data": Bits8,
        "link_val": Bits1,
        "frame_sync": Bits1,
        "busy": Bits1,
        # to the converters and the array's addressing
        "dac": mk_bits(8 * lanes),
        "hold": Bits1,
        "wake": Bits1,
        "convert": Bits1,
        "unsigned_": Bits1,
        "mode": Bits2,
        "row": Bits10,
        "group": Bits8,
        "k": Bits3,
        "sub": Bits2,
        "en": mk_bits(lanes),
        "balance": mk_bits(register_map().trims[0].width),
        # to the pixels and their amplifiers
        "pixel_reset": Bits1,
        "shutter": Bits1,
        "ref_ctl": Bits1,
        "integrate": Bits1,
        "expose": Bits1,
        "cm_reset": Bits1,
        "read": Bits1,
        "sample": Bits1,
        "tap": Bits2,
        "amp_row": Bits10,
        "reset_row": Bits10,
    }
    return inputs, outputs


def declare_pins(s, lanes: int) -> None:
    """Give the component ``s`` its ports."""
    inputs, outputs = pins(lanes)
    for name in dict.fromkeys((*ORDER, *inputs, *outputs)):  # by interface: SPI, link, converters, amplifiers
        setattr(s, name, InPort(inputs[name]) if name in inputs else OutPort(outputs[name]))
