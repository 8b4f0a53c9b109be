"""Compile the frame bench once, cached by content, and run frames through it."""
