"""QuadDivider: octant, ratio, amplitude and phase of a vector; three dividing variants and CORDIC."""

from talbot.rtl.quad_divider.cordic_rtl import Cordic
from talbot.rtl.quad_divider.quad_divider_cl import QuadDividerCL
from talbot.rtl.quad_divider.quad_divider_fl import QuadDividerFL
from talbot.rtl.quad_divider.quad_divider_rtl import QuadDividerPipelined, QuadDividerRadix2, QuadDividerRadix4
from talbot.rtl.quad_divider.variants import quad_divider, ratio_bits, timing

__all__ = [
    "Cordic",
    "QuadDividerCL",
    "QuadDividerFL",
    "QuadDividerPipelined",
    "QuadDividerRadix2",
    "QuadDividerRadix4",
    "quad_divider",
    "ratio_bits",
    "timing",
]
