"""TestChip1 at functional level: the golden chip at the pins."""

from pymtl3 import Component, update_ff

from talbot.rtl.test_chip_1.golden import HALTED, REGISTER, WORD_WAITS, WRITE, GoldenChip
from talbot.rtl.test_chip_1.memory_rtl import BANK_WORDS, BANKS
from talbot.rtl.test_chip_1.ports import declare_chip_ports


class TestChip1FL(Component):
    """A transfer takes effect with its last byte; programs take no time."""

    __test__ = False  # not a test class

    def construct(s, bank_words=BANK_WORDS):
        declare_chip_ports(s)
        s.clear(bank_words)

        @update_ff
        def behave():
            if s.host2chip.val & s.host2chip.rdy:
                s.sent += bytes([int(s.host2chip.msg)])
                s.transfer()
            if s.chip2host.val & s.chip2host.rdy:
                s.answer = s.answer[1:]
            if s.reset:
                s.clear(bank_words)
            status = s.chip.read(REGISTER)
            s.host2chip.rdy <<= not s.answer
            s.chip2host.val <<= len(s.answer) > 0
            s.chip2host.msg <<= s.answer[0] if s.answer else 0
            s.word_waits <<= bool(status & WORD_WAITS)
            s.halted <<= bool(status & HALTED)

    def clear(s, bank_words):
        """Return to the state after a reset; the memory's words are lost."""
        s.chip, s.sent, s.answer = GoldenChip(BANKS * bank_words), b"", b""

    def transfer(s):
        """Make the transfer whose bytes are complete."""
        if len(s.sent) >= 4:
            writes = s.sent[1] & WRITE >> 8
            if len(s.sent) == 4 + 4 * bool(writes) * int.from_bytes(s.sent[2:4], "little"):
                s.answer, s.sent = s.chip.host(s.sent), b""

    def line_trace(s):
        return f"{s.host2chip} {s.chip2host}"
