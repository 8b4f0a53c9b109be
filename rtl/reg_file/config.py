"""The configuration and the status as packed structs, generated from the register map."""

from functools import cache

from pymtl3 import Bits1, mk_bits, mk_bitstruct

from talbot.models.parameters.registers import register_map


@cache
def chip_config() -> type:
    """Return the type ChipConfig: every configuration field by its name, and `trims`, the trim registers.

    The register of pixel type 0 is lowest; its value is in the low bits of its bytes.
    """
    chip = register_map()
    fields = {f.name: mk_bits(f.width) for f in chip.configuration if f.name != "trim"}
    return mk_bitstruct("ChipConfig", fields | {"trims": mk_bits(sum(8 * f.size for f in chip.trims))})


@cache
def chip_status() -> type:
    """Return the type ChipStatus: busy, and one-cycle strobes for the sticky bits that the chip sets."""
    chip = register_map()
    strobes = [f.name for f in chip.fields if f.access == "w1c" and f.name not in ("refused", "aborted")]
    return mk_bitstruct("ChipStatus", {"busy": Bits1, **dict.fromkeys(strobes, Bits1)})


@cache
def chip_state() -> type:
    """Return the type ChipState: the fields of the register `state`."""
    return mk_bitstruct("ChipState", {f.name: mk_bits(f.width) for f in register_map().state})
