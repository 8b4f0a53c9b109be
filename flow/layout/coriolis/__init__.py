"""Place and route with Coriolis, in a process of its own: `python -m talbot.flow.layout.coriolis request.json`."""
