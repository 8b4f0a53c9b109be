"""ngspice as a process, and what its transients show."""
