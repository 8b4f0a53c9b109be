"""ReadoutSeq at RTL for every class of array, and frames back to back after every kind of end.

Its simulators are in PyMTL, which compiles nothing: each array takes milliseconds to build.
"""

import random
from dataclasses import astuple
from itertools import product

import pytest

from talbot.models.parameters import LANES, TileParameters
from talbot.rtl.readout_seq import ReadoutSeq
from talbot.rtl.readout_seq.test.bench import (
    AFTER_RESET,
    Bench,
    Record,
    Size,
    check,
    check_given_up,
    messages,
    randomly,
    simulator,
)

OFFSETS = [(decimation, offset) for decimation in (1, 2, 3) for offset in range(1 << decimation)]


def sizes():
    """Every partial tile with every number of lanes, every tile, the smallest, the largest and the default array.

    Every other tile has its types in any order.
    """
    pick = random.Random(5)
    thesis = [(4, 6, lanes, 1 + i % 4, there) for i, (lanes, there) in enumerate(product(LANES, range(1, 7)))]
    others = [
        (rows, cols, LANES[(i + rows) % 6], 1 + cols % rows, 1 + rows % cols)
        for i, (rows, cols) in enumerate(product(range(1, 5), range(1, 7)))
    ]
    found = [Size(1, 1, 1), Size(1024, 1536, 32), Size(1023, 1531, 1), Size(384, 384, 8)]
    for i, (tile_rows, tile_cols, lanes, rows_there, cols_there) in enumerate(thesis + others):
        down = 256 if i % 3 == 0 else pick.choice((1, 2, 3, 17))
        across = 256 if i % 4 == 1 else pick.choice((1, lanes, lanes + 1, 2 * lanes + pick.randint(0, lanes)))
        rows, cols = tile_rows * (down - 1) + rows_there, tile_cols * (across - 1) + cols_there
        order = TileParameters.small(tile_rows, tile_cols).order
        order = order if i % 2 else tuple(pick.sample(order, len(order)))
        found.append(Size(rows, cols, lanes, tile_rows, tile_cols, order))
    return found


def named(size, slow):
    """A parameter of a test: the size with its name, slow or not."""
    name = "{}x{}_{}_{}_{}".format(*astuple(size))
    return pytest.param(size, id=name, marks=pytest.mark.slow if slow else ())


def quickly(pick, err_at=None, hurry=(0.5, 1, 1)):
    """Return models of amplifiers and bank that take few cycles."""
    return randomly(pick.random(), err_at, longest=(1, 4), read=2, hurry=hurry)


def cut(ports, axis, first, last):
    """The window from tile ``first`` to ``last`` of 'row' or 'col'."""
    return ports | {f"{axis}0": first, f"{axis}1": last}


def any_window(size, pick, decimation):
    """Ports of a window anywhere, often at an edge, of so few tiles that the frame is short."""
    ports = size.whole(decimation=decimation)
    for axis, tiles, most in zip(("row", "col"), size.tiles, (2, 3 * size.lanes)):
        span = min(tiles, pick.randint(1, most << decimation))
        first = pick.choice((0, tiles - span, pick.randint(0, tiles - span)))
        ports = cut(ports, axis, first, first + span - 1)
    return ports


def any_mode(size, ports, pick):
    """Return the ports with any mode, overlap and exposure; a pixel of a long frame has a sample or two."""
    scan = size.scan(ports)
    modes = range(4) if scan and len(messages(scan)) < 40 else range(2)
    how = {"mode": pick.choice(modes), "overlap": pick.randint(0, 1), "exposure": pick.choice((0, 0, 1, 2, 9))}
    return ports | how


def types_of(size, rows, cols):
    """Mask of the types at the rows and columns of a tile."""
    return sum(1 << size.order[size.tile_cols * row + k] for row in rows for k in cols)


def frames(size, pick):
    """Ports of frames that have a step: the last tile, the array down and across, windows anywhere."""
    last_row, last_col = (tiles - 1 for tiles in size.tiles)
    rows, cols = range(size.tile_rows), range(size.tile_cols)
    corner = cut(cut(size.whole(), "row", last_row, last_row), "col", last_col, last_col)
    yield corner
    yield corner | {"row0": 0, "mask": types_of(size, pick.sample(rows, 1), [0]), "decimation": 3}
    yield corner | {"col0": 0, "mask": types_of(size, [0], cols[-1:] if last_col else [0])}
    for decimation in range(4):
        types = (pick.sample(axis, pick.randint(1, len(axis))) for axis in (rows, cols))
        yield any_window(size, pick, decimation) | {"mask": types_of(size, *types)}
    yield any_window(size, pick, pick.randint(0, 3)) | {"mask": 1 << pick.choice(size.order)}


def column_choices(size, pick):
    """Ports of frames with every choice of columns of a tile, and every decimation from every tile."""
    (last_row, last_col), cols = (tiles - 1 for tiles in size.tiles), range(size.tile_cols)
    for bits in range(1, 1 << len(cols)):
        mask = types_of(size, [0], [k for k in cols if bits >> k & 1])
        yield size.whole(row0=last_row, col0=last_col - 1, col1=last_col - pick.randint(0, 1), mask=mask)
    for decimation, offset in OFFSETS:
        ports = size.whole(row0=last_row, mask=types_of(size, [0], [0]), decimation=decimation)
        yield cut(ports, "col", last_col - 16 - offset, last_col - pick.randint(0, 9))


def row_choices(size, pick):
    """Return ports of frames with every choice of rows, and with every type alone."""
    (last_row, last_col), rows = (tiles - 1 for tiles in size.tiles), range(size.tile_rows)
    for bits in range(1, 1 << len(rows)):
        mask = types_of(size, [row for row in rows if bits >> row & 1], [0])
        yield size.whole(row0=last_row - 2, row1=last_row - pick.randint(0, 1), col0=last_col, mask=mask)
    for decimation, offset in OFFSETS:
        ports = size.whole(col0=last_col, mask=types_of(size, [0], [0]), decimation=decimation)
        yield cut(ports, "row", last_row - 16 - offset, last_row - pick.randint(0, 9))
    yield from (size.whole(row1=0, mask=1 << kind) for kind in size.order)


def refused(size):
    """Ports that are refused: nothing selected, or a tile outside the array or its order."""
    last_row, last_col = (tiles - 1 for tiles in size.tiles)
    rows, cols = range(size.tile_rows), range(size.tile_cols)
    yield size.whole(mask=(2**24 - 1) & ~types_of(size, rows, cols))
    for axis, last in (("row", last_row), ("col", last_col)):
        yield from (size.whole() | {f"{axis}1": beyond} for beyond in {last + 1, 255} if last < beyond < 256)
        if last:
            yield cut(size.whole(), axis, last, last - 1)
    yield size.whole(col0=last_col, mask=types_of(size, rows, cols[size.cols - size.tile_cols * last_col :]))
    yield size.whole(row0=last_row, mask=types_of(size, rows[size.rows - size.tile_rows * last_row :], cols))


SOME_LANES = [pytest.param(lanes, marks=() if lanes in (1, 4, 32) else pytest.mark.slow) for lanes in LANES]


class TestReadoutSeqSizes:
    verilog = None  # in PyMTL; not recorded: verif/coverage would compile every size

    @pytest.mark.parametrize("size", [named(size, i > 3 and i % 3) for i, size in enumerate(sizes())])
    def test_every_size(self, size):
        """Each frame is complete, whatever was before: a frame, a refused start, an aborted frame or a reset."""
        self.run(size, frames(size, random.Random(repr(size))))
        bench = Bench(simulator(ReadoutSeq, size, False), *quickly(random.Random(0))[0])
        for ports in refused(size):
            self.refuse(bench, size, ports)

    @pytest.mark.parametrize("lanes", SOME_LANES)
    def test_every_choice_of_columns(self, lanes):
        size = Size(2, 6 * 40 + 5 - lanes % 6, lanes)
        self.run(size, column_choices(size, random.Random(lanes)))

    @pytest.mark.parametrize("lanes", SOME_LANES)
    def test_every_partial_tile_is_decimated(self, lanes):
        for there in range(1, 7):
            size = Size(1, 6 * 40 + there, lanes)
            mask = types_of(size, [0], range(6))
            self.run(size, [size.whole(mask=mask, col0=40 - (1 << d), decimation=d) for d in (1, 2, 3)])

    def test_every_choice_of_rows(self):
        size = Size(4 * 40 + 3, 6 + 5, 1)
        self.run(size, row_choices(size, random.Random(0)))

    @pytest.mark.sets_registers
    @pytest.mark.parametrize("bit", (8, 16, 24, 32, 40, 63))
    def test_carries_of_the_cycles(self, bit):
        """The count of the RTL passes a power of two, here soon after the start."""
        size, begin = Size(7, 31, 2), (1 << bit) - 9
        bench = Bench(simulator(ReadoutSeq, size, False), *quickly(random.Random(bit))[0])
        sim, starts = bench.sim, iter([True])

        def count_on():
            """Set the registers in the first cycle after the start, in which they are 0."""
            if next(starts, False):
                for register, value in (sim.count_low, begin & 0xFF), (sim.count_high, begin >> 8):
                    register @= value
                    register <<= value
            return 0

        record = bench.frame(size.whole(mask=types_of(size, [0], [0])), count_on)
        assert record.pins[-1]["cycles"] == begin + len(record.pins) - 2

    def run(self, size, frames):
        """Run frames one after the other in one simulator, some with an event ahead of them."""
        pick, wrong = random.Random(repr(size)), list(refused(size))
        bench = Bench(simulator(ReadoutSeq, size, False), *quickly(pick)[0])
        for ports in frames:
            ports = any_mode(size, ports, pick)
            other = pick.choice((ports, any_window(size, pick, pick.randint(0, 3))))
            self.spoil(bench, size, pick.choice((ports, any_mode(size, other, pick))), wrong, pick)
            surroundings, noise = quickly(pick)
            bench.surround(*surroundings)
            before = bench.cycle(Record()) | {"four_tap": ports["mode"] == 3}
            check(bench.frame(ports, noise), size.scan(ports), ports["overlap"], before)

    def spoil(self, bench, size, ports, wrong, pick):
        """Run an event before a frame: none, a refused start, a frame that the amplifiers refuse, a reset in one.

        ports: of the frame that does not end.
        """
        what = pick.choice(("nothing", "nothing", "refused", "aborted", "reset"))
        if what == "refused":
            self.refuse(bench, size, pick.choice(wrong))
        elif what == "aborted" and (scan := size.scan(ports)):
            row = pick.randrange(min(2, len(scan.row_list)))
            bench.surround(*quickly(pick, (row, pick.randint(0, 6), pick.randint(0, 1)))[0])
            check_given_up(bench.frame(ports), scan)
        elif what == "reset":
            bench.drive(**ports)
            if pick.random() < 0.3:  # while an offer waits that ends an aborted frame
                bench.surround(*quickly(pick, (0, pick.randint(1, 4), 0), hurry=(0,))[0])
            for cycle in range(pick.randint(1, 25)):
                bench.cycle(Record(), start=not cycle)
            bench.reset()
            bench.surround(*quickly(pick)[0])
            for bench.answer in ((0, 1), (1, 0), (0, 0)):  # the amplifiers have no row: their answers change nothing
                assert bench.cycle(Record()) == AFTER_RESET | {"four_tap": ports["mode"] == 3}

    def refuse(self, bench, size, ports):
        """Start with ports that have no scan."""
        assert size.scan(ports) is None
        before = bench.cycle(Record())
        check(bench.frame(ports), None, 0, before | {"four_tap": ports["mode"] == 3})
