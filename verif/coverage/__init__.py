"""Coverage of the exported Verilog by each block's own tests, and the test plans that say what must be covered."""
