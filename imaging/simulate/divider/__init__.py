"""The quadrature divider with every input there is."""
