"""A bench for Proc at any level: memories with latencies, a manager with words, willingness by cycle."""

from collections import deque
from functools import cache
from itertools import cycle

from talbot.rtl.harness.testbench import build
from talbot.rtl.messages import MemReq
from talbot.rtl.proc.golden import Access, Memory

ALWAYS = (True,)


@cache
def simulator(cls, verilog=False):
    return build(cls(), verilog)


class Bench:
    """One processor. log: values at its output streams by cycle; requests: addresses of instructions."""

    def __init__(self, cls, verilog, hart_id=0):
        self.sim = simulator(cls, verilog)
        self.hart_id = hart_id

    def reset(self):
        for name in ("imem_req", "dmem_req", "to_manager"):
            getattr(self.sim, name).rdy @= 0
        for name in ("imem_resp", "dmem_resp", "from_manager"):
            getattr(self.sim, name).val @= 0
        self.sim.hart_id @= self.hart_id
        self.sim.reset @= 1
        self.sim.sim_tick()
        self.sim.reset @= 0

    def run(self, program, words=(), willing=ALWAYS, latencies=(1,), limit=20_000):
        """Reset, then run ``program`` until it stops; returns whether it did within ``limit`` cycles.

        willing: by cycle, at each of the six streams from another place in it on. latencies: cycles from a request to
        its response, in turn, 1 or more; responses are in order.
        """
        sim, self.memory = self.sim, Memory.of(program)
        self.reset()
        self.accesses, self.sent, self.log, self.cycles = [], [], [], 0
        turns = iter([cycle([*willing[n % len(willing) :], *willing[: n % len(willing)]]) for n in range(6)])
        latencies, words = cycle(latencies), deque(words)
        waiting = {"imem": deque(), "dmem": deque()}  # (cycle of the response, word)
        offered = dict.fromkeys(("imem", "dmem", "manager"), False)  # what is offered stays
        ports = {n: (getattr(sim, f"{n}_req"), getattr(sim, f"{n}_resp"), next(turns), next(turns)) for n in waiting}
        receives, sends = next(turns), next(turns)
        for now in range(limit):
            for name, (req, resp, accepts, responds) in ports.items():
                req.rdy @= next(accepts)
                due = waiting[name] and waiting[name][0][0] <= now
                offered[name] = bool(next(responds) and due or offered[name])
                resp.val @= offered[name]
                resp.msg @= waiting[name][0][1] if offered[name] else 0xDEADBEEF
            sim.to_manager.rdy @= next(receives)
            offered["manager"] = bool(words) and (next(sends) or offered["manager"])
            sim.from_manager.val @= offered["manager"]
            sim.from_manager.msg @= words[0] if offered["manager"] else 0xBADC0DE
            sim.sim_eval_combinational()
            self.record()
            for name, (req, resp, _, _) in ports.items():
                if resp.val & resp.rdy:
                    waiting[name].popleft()
                    offered[name] = False
                if req.val & req.rdy:
                    access = Access(0, int(req.msg), 0) if name == "imem" else as_access(req.msg)
                    if name == "dmem":
                        self.accesses.append(access)
                    word = self.memory.access(access.strobe, access.address, access.data)
                    word = 0x5EED5EED if access.strobe else word  # no level may use a write's word
                    waiting[name].append((now + next(latencies), word))
            if sim.to_manager.val & sim.to_manager.rdy:
                self.sent.append(int(sim.to_manager.msg))
            if sim.from_manager.val & sim.from_manager.rdy:
                words.popleft()
                offered["manager"] = False
            if sim.halted:
                self.cycles = now
                return True
            sim.sim_tick()
        return False

    def record(self):
        """Keep the outputs of this cycle, a message while it is valid."""
        sim, streams = self.sim, ("imem_req", "dmem_req", "to_manager")
        outs = [getattr(sim, name) for name in streams]
        messages = tuple(str(out.msg) if out.val else None for out in outs)
        ready = tuple(bool(getattr(sim, name).rdy) for name in ("imem_resp", "dmem_resp", "from_manager"))
        self.log.append((messages, ready, bool(sim.halted)))


def as_access(message: MemReq) -> Access:
    return Access(int(message.strobe), int(message.address), int(message.data))
