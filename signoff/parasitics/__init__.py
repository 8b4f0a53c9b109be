"""Capacitances and resistances of the nets of a finished layout."""
