"""Faults at the chip's pins: waveforms of any shape into its Verilog, and its outputs."""
