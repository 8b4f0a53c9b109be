"""Random and hostile inputs for what reads bytes that others wrote: the stream's decoder, the host, the registers."""
