"""The same designs through OpenROAD: Tcl for `openroad` itself, flow-scripts, LibreLane, Tiny Tapeout."""
