"""Error against run time: one sweep a design parameter, each a table (CSV) and a plot."""
