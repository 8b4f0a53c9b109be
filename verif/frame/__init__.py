"""The whole-frame bench: chip, analog front end and SPI host in one simulator (bench.sv)."""
