"""Proc at cycle level: the cycles of its pipeline, results by the golden functions of isa.py."""

from dataclasses import dataclass

from pymtl3 import Component, update, update_ff

from talbot.rtl.messages import MemReq
from talbot.rtl.proc.fetch_rtl import IN_FLIGHT
from talbot.rtl.proc.isa import (
    BRANCHES,
    HART_ID,
    IMMEDIATE,
    LOADS,
    MASK,
    REGISTER,
    SHIFTS,
    STORES,
    Instruction,
    compute,
    decode,
    lanes,
    loaded,
    taken,
)
from talbot.rtl.proc.ports import declare_ports

HALT = Instruction("halt")  # of a word that is no instruction
USES_RS1 = {"jalr", "csrw", *BRANCHES, *LOADS, *STORES, *IMMEDIATE, *SHIFTS, *REGISTER}
USES_RS2 = {*BRANCHES, *STORES, *REGISTER}


@dataclass
class Execute:
    """An instruction in X with its operands, and what it does."""

    op: Instruction
    pc: int
    a: int
    b: int

    def __post_init__(self):
        op, a, b = self.op, self.a, self.b
        self.total, self.access, self.result = a + op.imm & MASK, None, 0
        self.target = None
        self.fault = op == HALT
        if op.name in LOADS or op.name in STORES:
            self.access = lanes(op.name, self.total, b)
            self.fault = self.access is None
        elif op.name in BRANCHES:
            self.target = self.pc + op.imm & MASK if taken(op.name, a, b) else None
        elif op.name in ("jal", "jalr"):
            self.result, self.target = self.pc + 4 & MASK, (self.pc + op.imm if op.name == "jal" else self.total) & MASK
        elif op.name in ("lui", "auipc"):
            self.result = op.imm + (self.pc if op.name == "auipc" else 0) & MASK
        elif op.name in REGISTER:
            self.result = compute(op.name, a, b)
        elif op.name in IMMEDIATE or op.name in SHIFTS:
            self.result = compute(op.name, a, op.imm & MASK)
        if self.target is not None and self.target & 2:
            self.fault = True
        if self.fault:
            self.target = 0  # a request to no address that the program computes

    @property
    def receives(self):
        return self.op.name == "csrr" and self.op.imm != HART_ID

    @property
    def leaves(self):
        return self.target is not None


class ProcCL(Component):
    """Cycle level of Proc: the same ports, and values in every cycle."""

    def construct(s):
        declare_ports(s)
        s.waits = s.x_go = s.d_go = False
        s.clear()

        @update
        def outputs():
            m, x = s.m, s.x
            s.waits = m is not None and m.access is not None and not s.dmem_resp.val
            s.dmem_resp.rdy @= m is not None and m.access is not None
            access = x is not None and x.access is not None
            sends, receives = x is not None and x.op.name == "csrw", x is not None and x.receives
            s.dmem_req.val @= access and not s.waits
            if access:
                s.dmem_req.msg @= MemReq(x.access[0], x.total & ~3, x.access[1])
            s.to_manager.val @= sends and not s.waits
            s.to_manager.msg @= x.a if sends else 0
            s.from_manager.rdy @= receives and not s.waits
            blocked = (access and not s.dmem_req.rdy) or (sends and not s.to_manager.rdy)
            s.x_go = x is not None and not (s.waits or blocked or receives and not s.from_manager.val)
            s.d_go = s.d is not None and (x is None or s.x_go) and not s.hazard(s.d[0])
            leave = s.x_go and x.leaves
            s.imem_req.val @= s.flying != IN_FLIGHT and (not s.halt or s.held)
            s.imem_req.msg @= x.target & ~3 if leave and not s.held else s.address
            s.imem_resp.rdy @= s.halt or s.d is None or s.d_go or s.drops > 0
            s.halted @= s.halt

        @update_ff
        def advance():
            if s.reset:
                s.clear()
            else:
                s.step()

    def clear(s):
        s.registers, s.d, s.x, s.m, s.halt = [0] * 32, None, None, None, False
        s.address, s.resume, s.pc, s.held, s.flying, s.drops = 0, None, 0, False, 0, 0

    def hazard(s, op):
        """Return whether an operand of ``op`` is not known yet."""
        for used, register in ((op.name in USES_RS1, op.rs1), (op.name in USES_RS2, op.rs2)):
            if used and register:
                if s.x is not None and s.x.op.rd == register:
                    if s.x.op.name in LOADS:
                        return True
                elif s.m is not None and s.m.op.rd == register and s.waits:
                    return True
        return False

    def step(s):
        """Advance every stage."""
        x, go, leave = s.x, s.x_go, s.x_go and s.x.leaves
        accepted, arrived = bool(s.imem_req.val & s.imem_req.rdy), bool(s.imem_resp.val & s.imem_resp.rdy)
        if go and x.op.name == "csrr":
            x.result = int(s.from_manager.msg if x.receives else s.hart_id)
        if not s.waits:
            if s.m is not None and s.m.op.rd and not s.m.fault:
                answer = int(s.dmem_resp.msg)
                load = s.m.op.name in LOADS
                s.registers[s.m.op.rd] = loaded(s.m.op.name, s.m.total, answer) if load else s.m.result
            s.m = x if go else None
        decoded, s.x = s.d, None if go else x
        fresh = arrived and s.drops == 0 and not leave and not s.halt
        if s.d_go:
            s.d = None
        if s.d_go and not leave:
            op, pc = decoded
            values = list(s.registers)
            if go and x.op.rd and x.op.name not in LOADS:
                values[x.op.rd] = x.result
            s.x = Execute(op, pc, values[op.rs1], values[op.rs2])
        if fresh:
            s.d = decode(int(s.imem_resp.msg)) or HALT, s.pc
        if leave:
            s.d = None
            s.halt = s.halt or x.fault
        s.fetch(accepted, arrived, fresh, x.target & ~3 if leave else None)

    def fetch(s, accepted, arrived, fresh, target):
        """Advance the requests for instructions. target: of an instruction that leaves the path."""
        stale = s.held if target is not None else s.resume is not None
        if arrived and s.drops:
            s.drops -= 1
        s.flying += accepted - arrived
        if target is not None:
            s.pc, s.drops = target, s.flying - (accepted and not s.held)
            s.resume = target
            if not s.held:
                s.address, s.resume = target + 4 * accepted & MASK, None
            elif accepted:
                s.address, s.resume = target, None
        else:
            s.pc = s.pc + 4 * fresh & MASK
            if accepted:
                s.drops += stale
                s.address = s.address + 4 & MASK if s.resume is None else s.resume
                s.resume = None
        s.held = bool(s.imem_req.val) and not accepted

    def line_trace(s):
        return f"{s.d} {s.x} {s.m}"
