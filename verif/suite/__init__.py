"""Every pytest test of the repository, counted by block and level."""
