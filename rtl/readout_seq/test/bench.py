"""The test bench of ReadoutSeq: the handshakes of amplifiers and converter bank, and a record of a frame."""

import random
from dataclasses import dataclass, field
from functools import cache

from talbot.models.digital.scan import Scan
from talbot.models.parameters import MODES, AmpTiming, FrameParameters, ParameterError, TileParameters, Window
from talbot.rtl.amp_ctrl import AmpCtrl
from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import END, FRAME, ROW, SAMPLE

CONFIGURATION = ("mode", "mask", "row0", "row1", "col0", "col1", "decimation", "overlap", "exposure")
QUIET = dict(start=0, amp_done=0, amp_err=0, bank_idle=1)
PINS = ("busy", "done", "cfg_err", "amp_start", "amp_row", "reset_row", "slot_resets", "slot_reads", "slot_opens")
PINS += ("four_tap", "hold_free", "cycles")
AFTER_RESET = dict.fromkeys(PINS, 0) | dict(slot_reads=1, hold_free=1, offer=None)  # the output pins
SLOT = dict.fromkeys(("amp_row", "reset_row", "slot_resets", "slot_reads", "slot_opens"), 0)
SMALL_TILE = 3, 5, (4, 14, 0, 9, 2, 7, 13, 1, 8, 3, 10, 6, 12, 5, 11)


@dataclass(frozen=True)
class Size:
    """Parameters of ReadoutSeq."""

    rows: int
    cols: int
    lanes: int
    tile_rows: int = 4
    tile_cols: int = 6
    order: tuple = TileParameters().order

    @property
    def tiles(self):
        return -(-self.rows // self.tile_rows), -(-self.cols // self.tile_cols)

    @property
    def arguments(self):
        return self.rows, self.cols, self.lanes, self.order, self.tile_rows, self.tile_cols

    def whole(self, **ports):
        """Values of the configuration ports for the whole array, all types, except for ``ports``."""
        rows, cols = self.tiles
        return (
            dict(mode=0, mask=2**24 - 1, row0=0, row1=rows - 1, col0=0, col1=cols - 1, decimation=0, overlap=0)
            | dict(exposure=0)
            | ports
        )

    def scan(self, ports):
        """The golden Scan, or None if these values of the ports are an error."""
        types = TileParameters().types[: self.tile_rows * self.tile_cols]
        try:
            frame = FrameParameters(
                Window(*(ports[n] for n in CONFIGURATION[2:6])),
                MODES[ports["mode"]],
                ports["mask"],
                decimation=ports["decimation"],
                timing=AmpTiming(exposure=ports["exposure"]),
            )
            return Scan(
                self.rows,
                self.cols,
                self.lanes,
                frame,
                TileParameters(self.tile_rows, self.tile_cols, types, self.order),
            )
        except ParameterError:
            return None


@cache
def simulator(cls, size, verilog):
    return build(cls(*size.arguments), verilog, f"ReadoutSeq_{size.rows}_{size.cols}_{size.lanes}")


def messages(scan):
    """The golden messages of a frame, (kind, row, group, k, sub, en); 0 in fields that a kind does not use."""
    out = [(FRAME, 0, 0, 0, 0, 0)]
    for row in scan.row_list:
        out.append((ROW, row, 0, 0, 0, 0))
        out += [(SAMPLE, s.row, s.group, s.k, s.sub, s.enable) for s in scan.steps(row) if s.enable]
    return out + [(END, 0, 0, 0, 0, 0)]


def lead(scan):
    """Return the slots from a row's reset to its read."""
    return 0 if scan.frame.mode == "tof" else scan.frame.timing.exposure


def slots(scan):
    """(row that is read or None, row that is reset or None) of every slot of a frame."""
    rows, nothing = [int(row) for row in scan.row_list], [None] * lead(scan)
    return list(zip(nothing + rows, rows + nothing))


def fields_of(msg):
    """Return the fields of a StepMsg as in ``messages``."""
    kind = int(msg.kind)
    if kind == SAMPLE:
        return (kind, *(int(getattr(msg, name)) for name in ("row", "group", "k", "sub", "en")))
    return kind, int(msg.row) if kind == ROW else 0, 0, 0, 0, 0


def amplifiers(integrate, read, err_at=None):
    """AmpCtrl's handshake, a cycle a yield: yields (amp_done, amp_err), receives (amp_start, hold_free).

    integrate, read: functions that give a row's cycles. From start to done there are integrate + read + 1.
    err_at: (row counted from 0, cycles after its start, amp_done too) at which amp_err rises, to stay until the
    next start.
    """
    err, number = 0, -1
    start, _ = yield 0, 0
    while True:
        while not start:
            start, _ = yield 0, err
        err, number = 0, number + 1
        if err_at and err_at[0] == number:
            for _ in range(err_at[1]):
                start, _ = yield 0, 0
                assert not start
            err = 1
            start, _ = yield err_at[2], err
            continue
        for _ in range(integrate()):
            start, free = yield 0, 0
            assert not start, "amp_start while a row is in progress"
        while not free:
            start, free = yield 0, 0
        for _ in range(read()):
            start, _ = yield 0, 0
        start, _ = yield 1, 0


@cache
def amp_ctrl_simulator():
    return build(AmpCtrl())


def amp_ctrl(timing, four_tap):
    """The real AmpCtrl instead of ``amplifiers``; timing: AmpTiming, or None for durations of 0."""
    sim = amp_ctrl_simulator()
    for name in ("t_reset", "t_int", "t_cm", "t_settle", "t_read", "t_guard", "n_cm"):
        port = getattr(sim, name)
        port @= getattr(timing, name) if timing else 0
    sim.four_tap @= int(four_tap)
    sim.reset @= 1
    sim.sim_tick()
    sim.reset @= 0
    while True:
        start, free = yield int(sim.done), int(sim.cfg_err)
        assert not (start and sim.busy), "amp_start while a row is in progress"
        assert free or not sim.read, "a sample-and-hold in use is overwritten"
        sim.start @= start
        sim.hold_free @= free
        sim.sim_tick()


def bank(ready, conversion):
    """AdcBank's handshake: yields (rdy, idle), receives whether a step was taken. Functions: rdy, cycles of a step."""
    busy = 0
    while True:
        taken = yield ready(), int(busy == 0)
        busy = conversion() if taken else max(0, busy - 1)


def randomly(seed, err_at=None, longest=(2, 40), read=9, hurry=(0.1, 0.5, 0.9, 1)):
    """Return amplifiers and bank with random, partly extreme timing, and random starts while busy."""
    noise = random.Random(seed)
    longest, hurry = noise.choice(longest), noise.choice(hurry)
    return (
        amplifiers(lambda: noise.randint(1, longest), lambda: noise.randint(1, read), err_at),
        bank(lambda: int(noise.random() < hurry), lambda: noise.randint(0, 3)),
    ), lambda: noise.randint(0, 1)


@dataclass
class Record:
    """The values at the ports by cycle; `start` is high in cycle 0."""

    taken: list = field(default_factory=list)  # (cycle, message)
    starts: list = field(default_factory=list)  # (cycle, (row that is read or None, row that is reset or None))
    dones: list = field(default_factory=list)
    idle: list = field(default_factory=list)  # bank_idle of every cycle
    pins: list = field(default_factory=list)  # and the output pins
    standing: tuple = None  # an offer that was not taken in the last cycle

    @property
    def messages(self):
        return [msg for _, msg in self.taken]


def check(record, scan, overlap, before):
    """Check one frame's record; overlap: rows are exposed while others convert.

    overlap: the port, or None of a level that never overlaps.
    before: the pins, which must not change if there is no frame.
    """
    if scan is None:
        before |= {"slot_opens": record.pins[1]["slot_opens"]}  # follows the configuration
        assert record.pins[1] == before | {"cfg_err": 1} and not record.taken and not record.starts
        return
    assert record.messages == messages(scan)
    assert [slot for _, slot in record.starts] == slots(scan)
    assert {pins["slot_opens"] for pins in record.pins[1:] if pins["slot_resets"]} == {int(lead(scan) > 0)}
    assert not any(pins["slot_opens"] for pins in record.pins[1:] if not pins["slot_resets"])
    assert record.pins[-1]["done"] and not any(pins["done"] for pins in record.pins[:-1])
    assert not any(pins["cfg_err"] for pins in record.pins[1:])
    assert all(pins["busy"] for pins in record.pins[1:-1])
    assert record.pins[-1]["cycles"] == len(record.pins) - 2
    assert all(pins["four_tap"] == (scan.frame.mode == "tof") for pins in record.pins)
    check_holds(record, scan, overlap)


def check_holds(record, scan, overlap):
    """hold_free is low from a row's amp_done until its steps are converted, and the next row starts in time."""
    overlap = overlap or (lead(scan) and overlap is not None)
    used, last = [], {msg[1]: cycle for cycle, msg in record.taken if msg[0] == SAMPLE}
    for done, (row, _), start in zip(record.dones, slots(scan), [*record.starts[1:], (None, None)]):
        converted = done
        if row is not None:
            converted = record.idle.index(1, last[row] + 1)
            used += range(done + 1, converted + 1)
        assert start[0] in (None, 1 + (done if overlap else converted))
    assert [cycle for cycle, pins in enumerate(record.pins) if not pins["hold_free"]] == used


def check_given_up(record, scan):
    """Check the record of a frame that the amplifiers refused: the current offer is taken, then nothing more."""
    golden = messages(scan)
    assert record.messages == golden[: len(record.messages)] and len(record.messages) < len(golden)
    ends = {"cycles": 0, "four_tap": 0} | SLOT
    assert record.pins[-1] | ends == AFTER_RESET | ends | {"cfg_err": 1}


class Bench:
    """A simulator of any level with models of amplifiers and bank that keep their state between frames."""

    def __init__(self, sim, amplifier, converters):
        self.sim = sim
        self.surround(amplifier, converters)
        self.reset()

    def drive(self, **ports):
        for name, value in ports.items():
            port = getattr(self.sim, name)
            port @= value

    def reset(self):
        self.drive(**QUIET, reset=1)
        self.sim.step.rdy @= 0
        self.sim.sim_tick()
        self.sim.reset @= 0

    def cycle(self, record, start=0):
        """Run one clock cycle; returns the pins in it."""
        sim = self.sim
        ready, idle = self.supply
        self.drive(start=start, amp_done=self.answer[0], amp_err=self.answer[1], bank_idle=idle)
        sim.step.rdy @= ready
        sim.sim_eval_combinational()
        pins = {name: int(getattr(sim, name)) for name in PINS}
        pins["offer"] = fields_of(sim.step.msg) if sim.step.val else None
        taken = pins["offer"] is not None and ready
        number = len(record.pins)
        assert record.standing in (None, pins["offer"]), "an offer was changed or withdrawn"
        record.standing = None if taken else pins["offer"]
        record.pins.append(pins)
        record.idle.append(idle)
        if taken:
            record.taken.append((number, pins["offer"]))
        if pins["amp_start"]:
            read, reset = (
                pins[f"{row}_row"] if pins[f"slot_{on}"] else None
                for row, on in (("amp", "reads"), ("reset", "resets"))
            )
            record.starts.append((number, (read, reset)))
        if self.answer[0]:
            record.dones.append(number)
        self.answer = self.amplifier.send((pins["amp_start"], pins["hold_free"]))
        self.supply = self.converters.send(taken and pins["offer"][0] == SAMPLE)
        sim.sim_tick()
        return pins

    def surround(self, amplifier, converters):
        """Replace the models of amplifiers and bank, while none is busy."""
        self.amplifier, self.converters = amplifier, converters
        self.answer, self.supply = next(amplifier), next(converters)

    def frame(self, ports, noise=lambda: 0, limit=12_000):
        """Start a frame and run until busy falls; ``noise``: starts while busy. Returns Record."""
        record = Record()
        self.drive(**ports)
        self.cycle(record, start=1)
        while self.cycle(record, start=noise() if self.sim.busy else 0)["busy"]:
            assert len(record.pins) < limit
        return record
