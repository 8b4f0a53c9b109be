"""Coverage of the exported Verilog by each block's own tests, and the test plans that set what must be covered."""
