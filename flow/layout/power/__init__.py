"""Power of cells and IR drop of supplies."""
