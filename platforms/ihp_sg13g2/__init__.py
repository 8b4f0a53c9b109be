"""IHP SG13G2, 130 nm BiCMOS: all that the flow knows of it."""
