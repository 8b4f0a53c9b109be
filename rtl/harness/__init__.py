"""Harness of a block's tests: a test bench for every level, and the block's Verilog in Verilator and Icarus."""
