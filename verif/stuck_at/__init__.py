"""Stuck-at coverage of the chip's gates by a functional test at its pins."""
