"""The command-line program: `python -m talbot`."""
