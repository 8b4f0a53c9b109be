"""Decoder at RTL: control signals and immediate of an instruction's word."""

from pymtl3 import Bits1, Bits3, Bits12, Component, InPort, OutPort, Wire, concat, mk_bitstruct, sext, update

from talbot.rtl.proc.isa import FROM_MANAGER, HART_ID, TO_MANAGER

ALU, SUM, LOAD, STORE, BRANCH, JUMP, CHANNEL, HALT = range(8)  # kind; CHANNEL: a word from or to the manager
CSR_IN, CSR_OUT, CSR_ID = FROM_MANAGER, TO_MANAGER, HART_ID  # names in the Verilog

Control = mk_bitstruct(
    "ProcControl",
    {
        "kind": Bits3,
        "funct3": Bits3,  # of the ALU, of the access, of the branch; at CHANNEL 1 sends
        "alternative": Bits1,
        "immediate": Bits1,  # the ALU's second operand
        "from_rs1": Bits1,  # base of the sum
        "from_pc": Bits1,
        "writes": Bits1,  # rd, which is not x0
    },
)


class Decoder(Component):
    def construct(s):
        # Interface
        s.word = InPort(32)
        s.hart_id = InPort(32)
        s.control = OutPort(Control)
        s.uses_rs1 = OutPort()
        s.uses_rs2 = OutPort()
        s.imm = OutPort(32)

        # Components
        s.opcode = Wire(7)
        s.funct3 = Wire(3)
        s.funct7 = Wire(7)
        s.plain = Wire()  # funct7 = 0
        s.other = Wire()  # funct7 = 0x20
        s.has_rd = Wire()
        s.jump = Wire(21)  # immediates
        s.branch = Wire(13)
        s.stored = Wire(12)
        s.kind = Wire(3)
        s.choice = Wire(3)
        s.alternative = Wire()
        s.immediate = Wire()
        s.from_rs1 = Wire()
        s.from_pc = Wire()
        s.writes = Wire()

        # Connections
        s.opcode //= s.word[0:7]
        s.funct3 //= s.word[12:15]
        s.funct7 //= s.word[25:32]

        # Logic
        @update
        def up_fields():
            s.plain @= s.funct7 == 0
            s.other @= s.funct7 == 0x20
            s.has_rd @= s.word[7:12] != 0
            s.jump @= concat(s.word[31], s.word[12:20], s.word[20], s.word[21:31], Bits1(0))
            s.branch @= concat(s.word[31], s.word[7], s.word[25:31], s.word[8:12], Bits1(0))
            s.stored @= concat(s.word[25:32], s.word[7:12])
            s.control @= Control(s.kind, s.choice, s.alternative, s.immediate, s.from_rs1, s.from_pc, s.writes)

        @update
        def up_control():
            s.kind @= HALT
            s.choice @= s.funct3
            s.alternative @= 0
            s.immediate @= 0
            s.from_rs1 @= 0
            s.from_pc @= 0
            s.uses_rs1 @= 0
            s.uses_rs2 @= 0
            s.writes @= s.has_rd
            s.imm @= sext(s.word[20:32], 32)
            if (s.opcode == 0x37) | (s.opcode == 0x17):  # lui, auipc
                s.kind @= SUM
                s.from_pc @= ~s.opcode[5]
                s.imm @= concat(s.word[12:32], Bits12(0))
            elif s.opcode == 0x6F:  # jal
                s.kind @= JUMP
                s.from_pc @= 1
                s.imm @= sext(s.jump, 32)
            elif (s.opcode == 0x67) & (s.funct3 == 0):  # jalr
                s.kind @= JUMP
                s.from_rs1 @= 1
                s.uses_rs1 @= 1
            elif (s.opcode == 0x63) & (s.funct3[1:3] != 1):
                s.kind @= BRANCH
                s.from_pc @= 1
                s.uses_rs1 @= 1
                s.uses_rs2 @= 1
                s.writes @= 0
                s.imm @= sext(s.branch, 32)
            elif (s.opcode == 0x03) & (s.funct3[0:2] != 3) & (s.funct3 != 6):
                s.kind @= LOAD
                s.from_rs1 @= 1
                s.uses_rs1 @= 1
            elif (s.opcode == 0x23) & (s.funct3 < 3):
                s.kind @= STORE
                s.from_rs1 @= 1
                s.uses_rs1 @= 1
                s.uses_rs2 @= 1
                s.writes @= 0
                s.imm @= sext(s.stored, 32)
            elif (s.opcode == 0x13) & (
                (s.funct3[0:2] != 1) | s.plain | ((s.funct3 == 5) & s.other)  # shifts have a funct7
            ):
                s.kind @= ALU
                s.immediate @= 1
                s.alternative @= (s.funct3 == 5) & s.other
                s.uses_rs1 @= 1
            elif (s.opcode == 0x33) & (s.plain | (s.other & ((s.funct3 == 0) | (s.funct3 == 5)))):
                s.kind @= ALU
                s.alternative @= s.other
                s.uses_rs1 @= 1
                s.uses_rs2 @= 1
            elif (s.opcode == 0x0F) & (s.funct3 == 0):  # fence: accesses are in order
                s.kind @= SUM
                s.writes @= 0
            elif (s.opcode == 0x73) & (s.funct3 == 2) & (s.word[15:20] == 0):
                if s.word[20:32] == CSR_ID:
                    s.kind @= SUM
                    s.imm @= s.hart_id
                elif s.word[20:32] == CSR_IN:
                    s.kind @= CHANNEL
            elif (s.opcode == 0x73) & (s.funct3 == 1) & ~s.has_rd & (s.word[20:32] == CSR_OUT):
                s.kind @= CHANNEL
                s.uses_rs1 @= 1
                s.writes @= 0

    def line_trace(s):
        return f"{s.word} {s.kind}"
