"""StoreLanes and LoadLanes at RTL: parts of the memory's words from and to registers."""

from pymtl3 import Bits4, Component, InPort, OutPort, Wire, concat, sext, update, zext


class StoreLanes(Component):
    """`misaligned`: the address is not a multiple of the size, also of a load's."""

    def construct(s):
        s.size = InPort(2)  # 1, 2 or 4 bytes: 0, 1, 2
        s.low = InPort(2)  # of the address
        s.data = InPort(32)
        s.strobe = OutPort(4)
        s.word = OutPort(32)
        s.misaligned = OutPort()

        @update
        def up_lanes():
            s.word @= s.data
            s.strobe @= 15
            s.misaligned @= s.low != 0
            if s.size == 0:
                s.word @= concat(s.data[0:8], s.data[0:8], s.data[0:8], s.data[0:8])
                s.strobe @= Bits4(1) << zext(s.low, 4)
                s.misaligned @= 0
            elif s.size == 1:
                s.word @= concat(s.data[0:16], s.data[0:16])
                s.strobe @= Bits4(3) << zext(s.low, 4)
                s.misaligned @= s.low[0]


class LoadLanes(Component):
    def construct(s):
        s.funct3 = InPort(3)
        s.low = InPort(2)
        s.word = InPort(32)
        s.data = OutPort(32)

        s.part = Wire(16)

        @update
        def up_part():
            s.part @= s.word[0:16]
            if s.low[1]:
                s.part @= s.word[16:32]
            if s.low[0]:
                s.part @= concat(s.part[8:16], s.part[8:16])

        @update
        def up_data():
            s.data @= s.word
            if s.funct3[0:2] == 0:
                s.data @= sext(s.part[0:8], 32)
                if s.funct3[2]:
                    s.data @= zext(s.part[0:8], 32)
            elif s.funct3[0:2] == 1:
                s.data @= sext(s.part, 32)
                if s.funct3[2]:
                    s.data @= zext(s.part, 32)
