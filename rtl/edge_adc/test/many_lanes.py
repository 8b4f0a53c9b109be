"""The cycles of EdgeAdc for arrays of lanes of one shape: rtl.edge_adc.edge_adc_cl.LaneCycles, a lane an element."""

import numpy as np


class ManyLanes:
    """running, number: the decision in this cycle. ready: results not yet taken; elder: the result at the output."""

    def __init__(self, shape):
        self.running, self.above = np.zeros(shape, bool), np.zeros(shape, bool)
        self.number, self.bits, self.ready = (np.zeros(shape, np.int16) for _ in range(3))
        self.elder, self.younger = np.zeros(shape, np.int16), np.zeros(shape, np.int16)  # converted << 8 | code

    def look(self, unsigned, threshold, ternary):
        """Compute the outputs that depend on registers and the configuration: dac (while running), busy, free."""
        self.unsigned, self.threshold, self.ternary = unsigned, threshold, ternary
        self.first = np.where(ternary | ~unsigned & (threshold != 0), 2, 0)
        self.digit = self.number - self.first
        self.search = self.digit >= 0
        trial = self.bits | 0x80 >> np.clip(self.digit, 0, 7)
        self.dac = np.where(self.search, trial, np.where(self.number == 0, 128 + threshold, 129 - threshold))
        self.busy = self.running | (self.ready == 2)
        self.free = ~self.busy | self.running & (self.digit >= 6) & (self.ready == 0)

    def tick(self, go, comparator, rdy, reset):
        """End the cycle that `look` computed."""
        last = self.running & (self.digit == 7)
        second = self.running & (self.first > 0) & (self.number == 1)
        zero = second & (comparator & ~self.above | self.ternary)
        answers = np.where(comparator, self.dac, self.bits)
        code = answers - np.where(self.unsigned, 0, 128)
        inside = ~self.unsigned & (np.abs(code) < self.threshold)
        sign = np.where(self.above, 1, np.where(comparator, 0, 0xFF))
        result = np.where(zero, np.where(self.ternary, sign, 0), 0x100 | np.where(inside, 0, code & 0xFF))
        starts = go & (~self.busy | last & (self.ready == 0))
        taken = (self.ready > 0) & rdy
        self.elder = np.where((self.ready == 0) | taken, np.where(self.ready == 2, self.younger, result), self.elder)
        self.younger = np.where(self.ready == 1, result, self.younger)
        self.ready = np.where(reset, 0, self.ready + (last | zero) - taken)
        self.above = np.where(self.number == 0, comparator, self.above)
        self.bits = np.where(starts, 0, np.where(self.search, answers, self.bits))
        self.number = np.where(starts, 0, np.minimum(self.number + 1, 15))
        self.running = ~reset & (starts | self.running & ~last & ~zero)
