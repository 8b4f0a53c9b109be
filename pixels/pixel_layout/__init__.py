"""The pixel and its array drawn and checked: GDS, LEF, design rules, layout against circuit, pictures."""
