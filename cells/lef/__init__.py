"""LEF abstracts of cells from their GDS."""
