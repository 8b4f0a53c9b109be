"""A host for TestChip1 at any level."""

from functools import cache
from itertools import cycle

from talbot.rtl.harness.testbench import build
from talbot.rtl.test_chip_1.golden import CHANNEL, CONTROL, HALTED, RUNS, WORD_WAITS, WRITE, bytes_of, header, words_of

ALWAYS = (True,)
SMALL = 32  # words of a bank: 1 KB of memory, so that PyMTL simulates it


@cache
def simulator(cls, verilog):
    return build(cls(SMALL), verilog)


class Host:
    """One chip, reset. willing: by cycle, whether the host offers and takes a byte."""

    def __init__(self, cls, verilog, willing=ALWAYS):
        self.sim, self.turns, self.cycles = simulator(cls, verilog), cycle(willing), 0
        self.sim.host2chip.val @= 0
        self.sim.chip2host.rdy @= 0
        self.sim.reset @= 1
        self.sim.sim_tick()
        self.sim.reset @= 0

    def transfer(self, sent, answers=0, limit=20_000):
        """Send bytes, then take ``answers`` of the chip; returns these."""
        sim, sent, answer = self.sim, list(sent), b""
        for _ in range(limit):
            if not sent and len(answer) == answers:
                sim.host2chip.val @= 0
                sim.chip2host.rdy @= 0
                return answer
            willing = next(self.turns)
            sim.host2chip.val @= bool(sent) and (willing or bool(sim.host2chip.val))  # an offer stays
            sim.host2chip.msg @= sent[0] if sent else 0
            sim.chip2host.rdy @= willing and not sent
            sim.sim_eval_combinational()
            if sim.host2chip.val & sim.host2chip.rdy:
                del sent[0]
            if sim.chip2host.val & sim.chip2host.rdy:
                answer += bytes([int(sim.chip2host.msg)])
            self.tick()
        raise AssertionError(f"{len(sent)} bytes to send, {answers - len(answer)} to come")

    def tick(self):
        self.sim.sim_tick()
        self.cycles += 1

    def write(self, address, data):
        """Write bytes to memory, from the word at the byte ``address`` on."""
        data += bytes(-len(data) % 4)
        self.transfer(header(address // 4 | WRITE, len(data) // 4) + data)

    def read(self, address, words):
        """Return words of memory, from the byte ``address`` on."""
        return words_of(self.transfer(header(address // 4, words), 4 * words))

    def control(self, runs):
        self.transfer(header(CONTROL | WRITE, 1) + bytes([runs, 0, 0, 0]))

    def status(self):
        return int.from_bytes(self.transfer(header(CONTROL, 1), 4), "little")

    def send(self, *words):
        self.transfer(header(CHANNEL | WRITE, len(words)) + bytes_of(words))

    def receive(self, words=1):
        return words_of(self.transfer(header(CHANNEL, words), 4 * words))

    def run(self, limit=20_000):
        """Let the processor run until it stops or has a word; returns the cycles to that."""
        self.control(True)
        begin = self.cycles
        for _ in range(limit):
            if self.sim.halted | self.sim.word_waits:
                assert self.status() == RUNS | (HALTED if self.sim.halted else WORD_WAITS)
                return self.cycles - begin
            self.tick()
        raise AssertionError("the program does not stop")
