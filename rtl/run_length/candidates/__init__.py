"""Packers of token formats that were measured and not chosen, to know their size (docs/stream.md, Choice of format).

They have the ports of PayloadPacker and equal the encoders of flow.formats.tokens byte for byte.
"""

from .byte_pair_rtl import BytePairPacker
from .nibble_rtl import NibblePacker
from .rice_rtl import AdaptiveRicePacker, FixedRicePacker

__all__ = ["AdaptiveRicePacker", "BytePairPacker", "FixedRicePacker", "NibblePacker"]
