"""TestChip1 at RTL: it connects processor, sorter, memory and host port."""

from pymtl3 import Component, Wire, connect, update

from talbot.rtl.asp_chip.resets_rtl import children_reset_by
from talbot.rtl.proc import Proc
from talbot.rtl.test_chip_1.device_rtl import DeviceSwitch
from talbot.rtl.test_chip_1.host_port_rtl import HostPort
from talbot.rtl.test_chip_1.memory_rtl import BANK_WORDS, BANKS, REQUESTERS, Bank, MemoryPort
from talbot.rtl.test_chip_1.ports import declare_chip_ports
from talbot.rtl.test_chip_1.sorter_rtl import Sorter


class TestChip1(Component):
    """bank_words: words of each of the eight banks, a power of two; fewer than 512 in tests that run in PyMTL."""

    __test__ = False  # not a test class

    def construct(s, bank_words=BANK_WORDS):
        # Interface
        declare_chip_ports(s)

        # Components
        s.held = Wire()  # processor and sorter are in reset
        s.host = HostPort()
        s.banks = [Bank(bank_words) for _ in range(BANKS)]
        s.host_memory = MemoryPort()
        with children_reset_by(s, s.held):
            s.proc = Proc()
            s.switch = DeviceSwitch()
            s.sorter = Sorter()
            s.data_memory = MemoryPort()
            s.fetch_memory = MemoryPort()
            s.sort_memory = MemoryPort()

        # Connections
        s.host2chip //= s.host.host2chip
        s.chip2host //= s.host.chip2host
        s.host.to_proc //= s.proc.from_manager
        s.host.from_proc //= s.proc.to_manager
        s.host.proc_waits //= s.proc.from_manager.rdy
        s.word_waits //= s.proc.to_manager.val
        s.host.halted //= s.proc.halted
        s.halted //= s.proc.halted
        s.proc.hart_id //= 0
        s.proc.dmem_req //= s.switch.req
        s.proc.dmem_resp //= s.switch.resp
        s.switch.sort_req //= s.sorter.req
        s.switch.sort_resp //= s.sorter.resp
        s.switch.mem_req //= s.data_memory.req
        s.switch.mem_resp //= s.data_memory.resp
        s.sorter.mem_req //= s.sort_memory.req
        s.sorter.mem_resp //= s.sort_memory.resp
        s.host.mem_req //= s.host_memory.req
        s.host.mem_resp //= s.host_memory.resp
        s.fetch_memory.req.val //= s.proc.imem_req.val
        s.fetch_memory.req.rdy //= s.proc.imem_req.rdy
        s.fetch_memory.req.msg.address //= s.proc.imem_req.msg
        s.fetch_memory.req.msg.strobe //= 0
        s.fetch_memory.req.msg.data //= 0
        s.proc.imem_resp //= s.fetch_memory.resp
        for name in REQUESTERS:
            port = getattr(s, f"{name}_memory")
            for b, bank in enumerate(s.banks):
                connect(port.asks[b], getattr(bank, f"{name}_asks"))
                connect(port.grants[b], getattr(bank, f"{name}_grant"))
                connect(port.msg, getattr(bank, f"{name}_msg"))
                connect(getattr(port, f"q{b}"), bank.q)

        # Logic
        @update
        def up_held():
            s.held @= s.reset | ~s.host.runs

    def line_trace(s):
        return f"{s.host.line_trace()} | {s.proc.line_trace()} | {s.sorter.line_trace()}"
