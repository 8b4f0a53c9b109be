"""Verification that spans blocks."""
