"""Random and hostile inputs for the stream decoder, the host functions and the register model."""
