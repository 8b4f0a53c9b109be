"""Learning what the methods of light fields know: from scenes that are made for it."""
