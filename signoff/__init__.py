"""What checks a layout, whoever drew it: decks, LVS, netlists, parasitics, antennas, density."""
