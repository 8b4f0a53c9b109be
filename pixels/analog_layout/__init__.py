"""The analog circuits drawn: transistors in strips, capacitors in arrays, comparator, lane, row driver."""
