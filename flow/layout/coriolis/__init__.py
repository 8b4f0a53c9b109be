"""Place and route with Coriolis, in a process of its own: `python -m flow.layout.coriolis request.json`."""
