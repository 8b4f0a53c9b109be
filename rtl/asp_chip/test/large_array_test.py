"""AspChip with the largest arrays: the bytes of some tiles, so that every bit of an address and every lane counts."""

from talbot.models.chip import golden_frame
from talbot.models.digital.host import frame_writes
from talbot.models.digital.pattern import PatternEnd
from talbot.models.parameters import (
    SHORT_TIMING,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    SensorParameters,
    TileParameters,
    Window,
)
from talbot.rtl.asp_chip import AspChip
from talbot.rtl.asp_chip.test.chip_bench import ChipBench
from talbot.rtl.harness.testbench import build

TILES = [(255, 255), (0, 85), (170, 0)]  # every bit of an address rises and falls


def sensor(tile_rows, tile_cols, lanes):
    """256 x 256 tiles, the last ones partial where a tile has more than a pixel."""
    array = ArrayParameters(256 * tile_rows - (tile_rows > 1), 256 * tile_cols - (tile_cols > 1))
    return SensorParameters(
        tile=TileParameters.small(tile_rows, tile_cols), array=array, chip=ChipParameters(lanes=lanes)
    )


class TestVerilog:
    verilog = True
    sensors = (sensor(4, 6, 1),)

    def test_tiles_of_the_largest_array(self):
        for sensor in self.sensors:
            array, tile, lanes = sensor.array, sensor.tile, sensor.chip.lanes
            top = AspChip(array.rows, array.cols, lanes, tuple(tile.order), tile.rows, tile.cols)
            sim = build(top, self.verilog, f"AspChip_{array.rows}x{array.cols}")
            pattern, types = PatternEnd(array.rows, array.cols, tile), tile.type_map(array.rows, array.cols)
            bench = ChipBench(sim, lanes, tile.cols)
            trims = [(-1) ** t * (20 * t + 3) for t in range(tile.n_types)]
            for number, (row, last) in enumerate(TILES):
                col = max(0, last - lanes + 1)
                frame = FrameParameters(
                    Window(row, row, col, last),
                    threshold=0,
                    test_pattern=True,
                    frame_number=number,
                    timing=SHORT_TIMING,
                )
                bench.stream.clear()
                bench.pins.clear()
                bench.write(frame_writes(frame, trims))
                bench.start()
                assert bytes(bench.stream) == golden_frame(None, sensor, frame, pattern).stream, (array, frame.window)
                assert bench.pins == {
                    (0, r, c, trims[types[r, c]] % 1024)
                    for r in range(tile.rows * row, min(tile.rows * (row + 1), array.rows))
                    for c in range(tile.cols * col, min(tile.cols * (last + 1), array.cols))
                }


class TestIcarus(TestVerilog):
    verilog = "icarus"
    sensors = sensor(3, 5, 2), sensor(1, 1, 32)
