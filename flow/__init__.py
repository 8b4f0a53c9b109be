"""Place and route: Verilog to GDS, sign-off of it, energy, die and hand-off."""
