"""Packers of the token formats that were compared by size (docs/stream.md, Choice of format), PayloadPacker chosen.

All have the ports of PayloadPacker; their bytes equal those of the encoders of flow.formats.tokens.
"""

from talbot.rtl.run_length.packer_rtl import PayloadPacker

from .byte_pair_rtl import BytePairPacker
from .nibble_rtl import NibblePacker
from .rice_rtl import AdaptiveRicePacker, FixedRicePacker

__all__ = ["AdaptiveRicePacker", "BytePairPacker", "FixedRicePacker", "NibblePacker", "PayloadPacker"]
