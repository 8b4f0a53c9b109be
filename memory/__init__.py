"""Memories drawn by script: a static RAM under plain logic rules."""
