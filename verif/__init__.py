"""What spans blocks: harnesses, exhaustive runs, two simulators."""
