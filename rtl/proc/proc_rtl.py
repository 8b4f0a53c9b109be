"""Proc at RTL: fetch (F), decode (D), execute (X), memory and write-back (M)."""

from pymtl3 import Bits2, Component, Wire, concat, update, update_ff

from talbot.rtl.messages import MemReq
from talbot.rtl.proc.access_rtl import LoadLanes, StoreLanes
from talbot.rtl.proc.alu_rtl import Alu
from talbot.rtl.proc.decoder_rtl import BRANCH, CHANNEL, HALT, JUMP, LOAD, STORE, SUM, Control, Decoder
from talbot.rtl.proc.fetch_rtl import Fetch
from talbot.rtl.proc.ports import declare_ports
from talbot.rtl.proc.registers_rtl import Registers


class Proc(Component):
    """Results go from X and M to D's operands. A branch is decided in X; it is predicted not taken."""

    def construct(s):
        # Interface
        declare_ports(s)

        # Components
        s.fetch = Fetch()
        s.decoder = Decoder()
        s.registers = Registers()
        s.alu = Alu()
        s.store = StoreLanes()
        s.load = LoadLanes()

        s.d_val = Wire()
        s.d_word = Wire(32)
        s.d_pc = Wire(32)
        s.d_go = Wire()
        s.d_a = Wire(32)
        s.d_b = Wire(32)
        s.x_hit_a = Wire()  # X's result is the operand
        s.x_hit_b = Wire()
        s.m_hit_a = Wire()
        s.m_hit_b = Wire()
        s.hazard = Wire()  # an operand is not known yet

        s.x_val = Wire()
        s.x_control = Wire(Control)
        s.x_rd = Wire(5)
        s.x_pc = Wire(32)
        s.x_a = Wire(32)
        s.x_b = Wire(32)
        s.x_imm = Wire(32)
        s.x_go = Wire()
        s.x_sum = Wire(32)
        s.x_base = Wire(32)
        s.x_result = Wire(32)
        s.x_access = Wire()
        s.x_receives = Wire()
        s.x_sends = Wire()
        s.x_leaves = Wire()  # a jump or a taken branch
        s.x_fault = Wire()  # it stops the processor
        s.x_blocked = Wire()

        s.m_access = Wire()
        s.m_load = Wire()
        s.m_writes = Wire()
        s.m_funct3 = Wire(3)
        s.m_rd = Wire(5)
        s.m_result = Wire(32)
        s.m_waits = Wire()
        s.m_out = Wire(32)

        # Connections
        s.fetch.req //= s.imem_req
        s.fetch.resp //= s.imem_resp
        s.fetch.halted //= s.halted
        s.decoder.word //= s.d_word
        s.decoder.hart_id //= s.hart_id
        s.registers.rs1 //= s.d_word[15:20]
        s.registers.rs2 //= s.d_word[20:25]
        s.registers.rd //= s.m_rd
        s.registers.data //= s.m_out
        s.alu.funct3 //= s.x_control.funct3
        s.alu.alternative //= s.x_control.alternative
        s.alu.a //= s.x_a
        s.store.size //= s.x_control.funct3[0:2]
        s.store.low //= s.x_sum[0:2]
        s.store.data //= s.x_b
        s.load.funct3 //= s.m_funct3
        s.load.low //= s.m_result[0:2]
        s.load.word //= s.dmem_resp.msg
        s.to_manager.msg //= s.x_a

        # Logic
        @update
        def up_memory():
            s.m_waits @= s.m_access & ~s.dmem_resp.val
            s.dmem_resp.rdy @= s.m_access
            s.m_out @= s.m_result
            if s.m_load:
                s.m_out @= s.load.data
            s.registers.write @= s.m_writes & ~s.m_waits

        @update
        def up_execute():
            s.x_base @= 0
            if s.x_control.from_pc:
                s.x_base @= s.x_pc
            elif s.x_control.from_rs1:
                s.x_base @= s.x_a
            s.x_sum @= s.x_base + s.x_imm
            s.alu.b @= s.x_b
            if s.x_control.immediate:
                s.alu.b @= s.x_imm

        @update
        def up_result():
            s.x_result @= s.alu.out
            if s.x_control.kind == JUMP:
                s.x_result @= s.x_pc + 4
            elif s.x_control.kind == CHANNEL:
                s.x_result @= s.from_manager.msg
            elif (s.x_control.kind == SUM) | (s.x_control.kind == LOAD):
                s.x_result @= s.x_sum

        @update
        def up_kind():
            s.x_access @= s.x_val & ((s.x_control.kind == LOAD) | (s.x_control.kind == STORE)) & ~s.store.misaligned
            s.x_sends @= s.x_val & (s.x_control.kind == CHANNEL) & s.x_control.funct3[0]
            s.x_receives @= s.x_val & (s.x_control.kind == CHANNEL) & ~s.x_control.funct3[0]
            s.x_leaves @= (s.x_control.kind == JUMP) | ((s.x_control.kind == BRANCH) & s.alu.taken)
            s.x_fault @= (
                (s.x_control.kind == HALT)
                | (((s.x_control.kind == LOAD) | (s.x_control.kind == STORE)) & s.store.misaligned)
                | (s.x_leaves & s.x_sum[1])
            )

        @update
        def up_requests():
            s.dmem_req.val @= s.x_access & ~s.m_waits
            s.dmem_req.msg @= MemReq(0, concat(s.x_sum[2:32], Bits2(0)), 0)
            if s.x_control.kind == STORE:
                s.dmem_req.msg @= MemReq(s.store.strobe, concat(s.x_sum[2:32], Bits2(0)), s.store.word)
            s.to_manager.val @= s.x_sends & ~s.m_waits
            s.from_manager.rdy @= s.x_receives & ~s.m_waits

        @update
        def up_go():
            s.x_blocked @= (
                s.m_waits
                | (s.x_access & ~s.dmem_req.rdy)
                | (s.x_sends & ~s.to_manager.rdy)
                | (s.x_receives & ~s.from_manager.val)
            )
            s.x_go @= s.x_val & ~s.x_blocked
            s.fetch.leave @= s.x_go & (s.x_leaves | s.x_fault)
            s.fetch.target @= concat(s.x_sum[2:32], Bits2(0))
            if s.x_fault:
                s.fetch.target @= 0  # no address that the program computes

        @update
        def up_operands():
            s.x_hit_a @= s.x_val & s.x_control.writes & (s.x_rd == s.d_word[15:20])
            s.x_hit_b @= s.x_val & s.x_control.writes & (s.x_rd == s.d_word[20:25])
            s.m_hit_a @= s.m_writes & (s.m_rd == s.d_word[15:20])
            s.m_hit_b @= s.m_writes & (s.m_rd == s.d_word[20:25])
            s.d_a @= s.registers.a
            if s.x_hit_a:
                s.d_a @= s.x_result
            elif s.m_hit_a:
                s.d_a @= s.m_out
            s.d_b @= s.registers.b
            if s.x_hit_b:
                s.d_b @= s.x_result
            elif s.m_hit_b:
                s.d_b @= s.m_out

        @update
        def up_decode():
            s.hazard @= (s.decoder.uses_rs1 & ((s.x_hit_a & (s.x_control.kind == LOAD)) | (s.m_hit_a & s.m_waits))) | (
                s.decoder.uses_rs2 & ((s.x_hit_b & (s.x_control.kind == LOAD)) | (s.m_hit_b & s.m_waits))
            )
            s.d_go @= s.d_val & ~s.hazard & (~s.x_val | s.x_go)
            s.fetch.free @= ~s.d_val | s.d_go

        @update_ff
        def up_stages():
            if s.reset:
                s.d_val <<= 0
                s.x_val <<= 0
                s.m_access <<= 0
                s.m_load <<= 0
                s.m_writes <<= 0
                s.halted <<= 0
            else:
                s.d_val <<= ~s.fetch.leave & (s.fetch.val | (s.d_val & ~s.d_go))
                s.x_val <<= (s.d_go & ~s.fetch.leave) | (s.x_val & s.x_blocked)
                s.halted <<= s.halted | (s.x_go & s.x_fault)
                if ~s.m_waits:
                    s.m_access <<= s.x_go & s.x_access
                    s.m_load <<= s.x_go & s.x_access & (s.x_control.kind == LOAD)
                    s.m_writes <<= s.x_go & ~s.x_fault & s.x_control.writes

        @update_ff
        def up_registers():
            if s.reset:
                s.d_word <<= 0
                s.d_pc <<= 0
                s.x_control <<= Control()
                s.x_rd <<= 0
                s.x_pc <<= 0
                s.x_a <<= 0
                s.x_b <<= 0
                s.x_imm <<= 0
                s.m_funct3 <<= 0
                s.m_rd <<= 0
                s.m_result <<= 0
            else:
                if s.fetch.val:
                    s.d_word <<= s.fetch.word
                    s.d_pc <<= s.fetch.pc
                if s.d_go:
                    s.x_control <<= s.decoder.control
                    s.x_rd <<= s.d_word[7:12]
                    s.x_pc <<= s.d_pc
                    s.x_a <<= s.d_a
                    s.x_b <<= s.d_b
                    s.x_imm <<= s.decoder.imm
                if s.x_go:
                    s.m_funct3 <<= s.x_control.funct3
                    s.m_rd <<= s.x_rd
                    s.m_result <<= s.x_result

    def line_trace(s):
        return (
            f"{s.imem_req} {s.d_pc if s.d_val else '.':>8} {s.x_pc if s.x_val else '.':>8} {'m' if s.m_access else '.'}"
        )
