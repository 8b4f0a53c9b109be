"""A finished layout as one archive, the same to the byte: all that who tapes it out, or builds it in, must have."""
