"""LEF files: macros read, and macros written."""
