"""AdcBank at cycle level: the RTL's cycles and stalls, data from models.digital.sar.decisions."""

from pymtl3 import Component, update, update_ff

from talbot.rtl.adc_bank.ports import TERNARY, declare_ports
from talbot.rtl.edge_adc.edge_adc_cl import LaneCycles
from talbot.rtl.messages import FRAME, SAMPLE, ScanMsg


class AdcBankCL(Component):
    """Cycle level of AdcBank: the same ports, and the same values in every cycle."""

    def construct(s, lanes=8):
        declare_ports(s, lanes)

        s.lanes = [LaneCycles() for _ in range(lanes)]
        s.at_pins = None  # (kind, row, en) of the step that converts, or of a mark that waits for the results
        s.leaving = []  # to be sent, in order: marks (ScanMsg) and lanes (int)

        def tick_lanes(taken_lane):
            for number, lane in enumerate(s.lanes):
                lane.tick(
                    bool(s.hold & s.en[number]),
                    bool(s.unsigned_),
                    int(s.threshold),
                    bool(s.mode == TERNARY),
                    bool(s.comparator[number]),
                    number == taken_lane,
                )

        def count(head):
            if isinstance(head, int):
                converted = s.lanes[head].result[1]
                s.made <<= s.made + int(converted)
                s.left_out <<= s.left_out + int(not converted)
            elif head.kind == FRAME:
                s.made <<= 0
                s.left_out <<= 0

        def move_on():
            if s.at_pins is not None and not s.leaving:
                kind, row, en = s.at_pins
                if kind == SAMPLE:
                    s.leaving = [lane for lane in range(lanes) if en >> lane & 1]
                else:
                    s.leaving = [ScanMsg(kind, row)]
                s.at_pins = None

        @update_ff
        def behave():
            taken = bool(s.step.val & s.step.rdy)
            starts = taken and bool(s.step.msg.kind == SAMPLE) and not s.reset
            if s.reset:
                s.lanes = [LaneCycles() for _ in range(lanes)]
                s.at_pins, s.leaving = None, []
                s.made <<= 0
                s.left_out <<= 0
            else:
                head = s.leaving.pop(0) if s.scan.val & s.scan.rdy else None
                if head is not None:
                    count(head)
                tick_lanes(head if isinstance(head, int) else None)
                move_on()
                if taken:
                    s.at_pins = int(s.step.msg.kind), int(s.step.msg.row), int(s.step.msg.en)
                    s.row <<= s.step.msg.row
                    s.group <<= s.step.msg.group
                    s.k <<= s.step.msg.k
                    s.sub <<= s.step.msg.sub
                    s.en <<= s.step.msg.en
            s.hold <<= starts
            s.step.rdy <<= not starts and s.at_pins is None and all(lane.free for lane in s.lanes)
            s.idle <<= not starts and not any(lane.busy for lane in s.lanes)
            s.dac <<= sum(lane.dac << 8 * number for number, lane in enumerate(s.lanes))
            head = s.leaving[0] if s.leaving else None
            if isinstance(head, int):  # a lane, whose result may not be ready
                result = s.lanes[head].result
                head = result and ScanMsg(SAMPLE, (len(s.leaving) == 1) << 9 | result[0] & 0xFF)
            s.scan.val <<= head is not None
            if head is not None:
                s.scan.msg <<= head

        @update
        def range_of_dac():
            s.unsigned_ @= s.mode[0:2] != 0

        @update
        def wakes():
            s.wake @= s.step.val & s.step.rdy & (s.step.msg.kind == SAMPLE)

    def line_trace(s):
        return f"{s.step} {'h' if s.hold else ' '} {len(s.leaving)} {s.scan}"
