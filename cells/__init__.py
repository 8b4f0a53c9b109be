"""Cell libraries from transistors: extraction, characterization, Liberty and LEF; the compact cells."""
