"""Messages of the streams between the blocks (docs/chip.md)."""

from functools import cache

from pymtl3 import Bits2, Bits3, Bits4, Bits8, Bits9, Bits10, Bits32, mk_bits, mk_bitstruct

FRAME, ROW, SAMPLE, END = range(4)  # ScanMsg.kind and StepMsg.kind

ScanMsg = mk_bitstruct("ScanMsg", {"kind": Bits2, "data": Bits10})

# strobe: bytes of the word at `address` to write, 0 to read; every request gets a word, a write's is not defined
MemReq = mk_bitstruct("MemReq", {"strobe": Bits4, "address": Bits32, "data": Bits32})

DivReq = mk_bitstruct("DivReq", {"x": Bits9, "y": Bits9})


@cache
def step_msg(lanes: int) -> type:
    """Return the type StepMsg for a bank of ``lanes`` converters."""
    return mk_bitstruct(
        f"StepMsg_{lanes}",
        {"kind": Bits2, "row": Bits10, "group": Bits8, "k": Bits3, "sub": Bits2, "en": mk_bits(lanes)},
    )


@cache
def div_resp(n_frac: int) -> type:
    """Return the type DivResp with a ratio of ``n_frac`` bits."""
    return mk_bitstruct(
        f"DivResp_{n_frac}",
        {
            "octant": Bits3,
            "ratio": mk_bits(n_frac),
            "zero": mk_bits(1),
            "phase": Bits8,
            "amp_valid": mk_bits(1),
            "amp": Bits8,
        },
    )
