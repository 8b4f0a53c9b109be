"""What the tests of a block run on: a test bench for every level, and the block's Verilog in Verilator and Icarus."""
