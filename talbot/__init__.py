"""The command-line program: `talbot`."""
