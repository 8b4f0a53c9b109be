"""Verilog of a block or a proof as a program, by Verilator: it replays recorded cycles, or answers line by line."""
