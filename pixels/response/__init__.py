"""A process's pixel: search, response, page."""
