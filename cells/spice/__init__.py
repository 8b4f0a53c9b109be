"""Transients in ngspice, run as a process, and what they show."""
