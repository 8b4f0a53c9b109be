"""AspChip at functional level: registers and golden frames at the chip's pins."""

from dataclasses import replace
from typing import Any

from pymtl3 import Component, Wire, connect, update, update_ff

from talbot.models.parameters import (
    NO_DIVIDER,
    AmpTiming,
    ArrayParameters,
    ChipParameters,
    FrameParameters,
    ParameterError,
    SensorParameters,
    TileParameters,
    Window,
    mode_of,
)
from talbot.models.parameters.registers import register_map
from talbot.rtl.amp_ctrl.ports import TIMING
from talbot.rtl.asp_chip.golden_run import GoldenRun, idle_pins
from talbot.rtl.asp_chip.pins import declare_pins
from talbot.rtl.reg_file import RegFileFL, chip_status


def frame_of(cfg: Any, has_phase: bool = True) -> FrameParameters:
    """Return the frame of a ChipConfig, without the durations. has_phase: whether the chip has a phase path.

    Raises ParameterError if the frame is invalid.
    """
    mode = mode_of(int(cfg.mode))
    return FrameParameters(
        Window(*(int(getattr(cfg, name)) for name in ("row0", "row1", "col0", "col1"))),
        mode,
        int(cfg.mask),
        int(cfg.threshold),
        int(cfg.decimation),
        has_phase and bool(cfg.phase) and mode == "tof",
        int(cfg.noise_floor),
        bool(cfg.overlap),
        bool(cfg.test_pattern),
        int(cfg.frame_number),
        resync=int(cfg.resync),
        calibration=int(cfg.calibration),
    )


def trims_of(cfg: Any) -> tuple[int, ...]:
    """Return the trim registers by pixel type, unsigned."""
    return tuple(int(cfg.trims) >> 8 * f.size * i & (1 << f.width) - 1 for i, f in enumerate(register_map().trims))


class AspChipFL(Component):
    """The bytes of AspChip without its timing: all steps are converted, then the frame is sent.

    The converters' pins have the chip's sequence, so any front end can be connected; the amplifiers' pins stay low,
    since rows take no time here. Parameters: see AspChip.
    """

    def construct(s, rows, cols, lanes, order, tile_rows=4, tile_cols=6, divider="radix4", n_frac=8, iterations=10):
        declare_pins(s, lanes)
        s.regs = RegFileFL(rows, cols, lanes, tile_rows, tile_cols, divider)
        for name in ("sclk", "csn", "mosi", "miso"):
            connect(getattr(s, name), getattr(s.regs, name))
        s.mode //= s.regs.cfg.mode[0:2]

        types = TileParameters().types[: tile_rows * tile_cols]
        s.sensor = SensorParameters(
            TileParameters(tile_rows, tile_cols, types, tuple(order)),
            ArrayParameters(rows, cols),
            chip=ChipParameters(lanes, divider, n_frac, iterations),
        )
        s.byte, s.byte_val = Wire(8), Wire()
        s.run = s.job = None
        s.spent = 0
        s.idle = idle_pins()

        def begin():
            """Start the configured frame; returns (cfg_err, amp_err)."""
            cfg = s.regs.cfg
            try:
                s.run = GoldenRun(s.sensor, frame_of(cfg, divider != NO_DIVIDER), trims_of(cfg))
                timing = AmpTiming(*(int(getattr(cfg, name)) for name in (*TIMING, "exposure")))
                s.run = replace(s.run, frame=replace(s.run.frame, timing=timing))
            except ParameterError as error:
                return True, str(error).startswith("t_")
            s.job = s.run.cycles(lambda: int(s.comparator), lambda: s.link_rdy)
            s.spent = 0
            return False, False

        @update_ff
        def behave():
            done = cfg_err = amp_err = False
            if s.reset or s.regs.abort_:
                s.run = s.job = None
                s.spent = 0
            elif s.job is not None:
                s.spent += 1
                done = next(s.job, s) is s
                if done:
                    s.job = None
            elif s.regs.start:
                cfg_err, amp_err = begin()
            busy = done or s.job is not None  # until `done` is set
            s.busy <<= busy
            s.regs.status <<= chip_status()(busy, done, cfg_err, amp_err)
            s.regs.cycles <<= s.spent
            s.regs.conversions_made <<= s.run.made if s.run else 0
            s.regs.conversions_left_out <<= s.run.left_out if s.run else 0
            pins = s.run.pins if s.run else s.idle
            s.dac <<= pins["dac"]
            s.hold <<= pins["hold"]
            s.wake <<= pins["wake"]
            s.convert <<= pins["convert"]
            s.unsigned_ <<= pins["unsigned_"]
            s.row <<= pins["row"]
            s.group <<= pins["group"]
            s.k <<= pins["k"]
            s.sub <<= pins["sub"]
            s.en <<= pins["en"]
            s.balance <<= pins["balance"]
            s.frame_sync <<= pins["frame_sync"]
            s.byte <<= pins["link_data"]
            s.byte_val <<= pins["link_val"]

        @update
        def link():
            s.link_data @= s.regs.loop.msg if s.regs.cfg.loop_enable else s.byte
            s.link_val @= s.regs.loop.val if s.regs.cfg.loop_enable else s.byte_val
            s.regs.loop.rdy @= s.link_rdy & s.regs.cfg.loop_enable
            s.miso_oe @= ~(s.csn | s.reset)

    def line_trace(s):
        return f"{s.row},{s.group},{s.k},{s.sub} {s.link_data if s.link_val else '  '}"
