"""Liberty libraries from measured cells: built, checked, read by tools, compared."""
