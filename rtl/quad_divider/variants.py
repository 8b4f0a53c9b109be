"""The variants by name, their parameters and their timing."""

from pymtl3 import Component

from talbot.rtl.quad_divider.cordic_rtl import RATIO_BITS, Cordic
from talbot.rtl.quad_divider.quad_divider_rtl import QuadDividerPipelined, QuadDividerRadix2, QuadDividerRadix4
from talbot.rtl.sizes import check_size

DIVIDING = {"radix2": QuadDividerRadix2, "radix4": QuadDividerRadix4, "pipelined": QuadDividerPipelined}


def check_variant(variant: str, n_frac: int, iterations: int) -> None:
    """Raise ParameterError unless the divider exists."""
    check_size(divider=variant, n_frac=n_frac, iterations=iterations)


def quad_divider(variant: str, n_frac: int = 8, iterations: int = 10) -> Component:
    """Return the RTL of ``variant`` ('radix2', 'radix4', 'pipelined' or 'cordic'). Raises ParameterError.

    n_frac: fraction bits of the ratio, 4..16 (not for CORDIC). iterations: of CORDIC, 4..16.
    """
    check_variant(variant, n_frac, iterations)
    return Cordic(iterations) if variant == "cordic" else DIVIDING[variant](n_frac)


def ratio_bits(variant: str, n_frac: int = 8) -> int:
    """Return the width of the response's ratio: n_frac, or the fixed width of CORDIC's ratio, which is 0."""
    return RATIO_BITS if variant == "cordic" else n_frac


def timing(variant: str, n_frac: int = 8, iterations: int = 10) -> tuple[int, int]:
    """Return latency and interval in cycles: request to first cycle of the response, and between two results."""
    check_variant(variant, n_frac, iterations)
    steps = {"radix2": n_frac, "radix4": -(-n_frac // 2), "pipelined": n_frac, "cordic": iterations}[variant]
    return steps + 1, 1 if variant == "pipelined" else steps + 2
