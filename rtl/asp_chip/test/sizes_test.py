"""A chip of any size differs from the proven and simulated one (8 x 13, two lanes) in its blocks' parameters only.

Without a phase path it lacks that block: the bank's messages go to the register ahead of the encoder.
"""

import random

import pytest

from talbot.models.parameters import NO_DIVIDER
from talbot.rtl.asp_chip import AspChip
from talbot.rtl.messages import ScanMsg

SIZES = {  # array, lanes, tile; divider, n_frac, iterations
    "small": (8, 13, 2, 4, 6, "radix4", 8, 10),
    "default": (384, 384, 8, 4, 6, "radix4", 8, 10),
    "largest": (1024, 1536, 32, 4, 6, "pipelined", 16, 10),
    "3 x 5": (515, 29, 16, 3, 5, "cordic", 8, 16),
    "2 x 4": (511, 3, 4, 2, 4, "radix2", 9, 4),
    "a pixel": (1, 1, 1, 1, 1, "cordic", 4, 7),
    "no phase path": (767, 640, 16, 4, 6, NO_DIVIDER, 8, 10),
}
BYPASS = {  # without a phase path: connections that the others lack
    *(frozenset((f"s.bank.scan.{name}", f"s.scan.recv.{name}")) for name in ("val", "rdy", "msg")),
    frozenset(("s.states.scan_rdy", "s.scan.recv.rdy")),
    frozenset(("s.phase_on", "Bits1(0x0)")),
}


def elaborated(size):
    """Return the chip of a size, with the types of its tile in any order, and that order."""
    tile_rows, tile_cols = size[3:5]
    order = tuple(random.Random(repr(size)).sample(range(tile_rows * tile_cols), tile_rows * tile_cols))
    top = AspChip(*size[:3], order, *size[3:])
    top.elaborate()
    return top, order


def connections(top):
    return {frozenset(map(repr, pair)) for pair in top.get_connect_order()}


@pytest.mark.parametrize("name", SIZES)
def test_the_blocks_have_the_size_of_the_chip(name):
    """Each is built with the chip's parameters; connections and logic between the blocks depend on none."""
    rows, cols, lanes, *tile, divider, n_frac, iterations = SIZES[name]
    top, order = elaborated(SIZES[name])
    given = {child.get_field_name(): child._dsl.args for child in top.get_child_components(repr)}
    expected = {
        "regs": (rows, cols, lanes, *tile, divider),
        "seq": (rows, cols, lanes, order, *tile),
        "bank": (lanes,),
        "phase": (lanes, divider, n_frac, iterations),
        "scan": (ScanMsg,),
        "encoder": (rows, cols, lanes, *tile),
        "generator": (lanes,),
        "balancer": (order, *tile, 10, 16),
        "gate": (17,),
    }
    wires = connections(elaborated(SIZES["small"])[0])
    if divider == NO_DIVIDER:
        del expected["phase"]
        wires = {pair for pair in wires if not any(end.startswith("s.phase.") for end in pair)} | BYPASS
    assert {name: args for name, args in given.items() if args} == expected
    assert connections(top) == wires
    assert all(block.__code__.co_freevars == ("s",) for block in top.get_update_blocks())
