"""Benches in cocotb of the chip and of its stream blocks, the same in Icarus and in Verilator."""
