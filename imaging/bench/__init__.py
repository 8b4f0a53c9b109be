"""The pixels' test chip on a bench: readings of its pads, simulated or measured, and what follows from them."""
