"""The drawn pixel in SPICE: full well, gain, linearity, noise, lag over corners; an EMVA 1288 style table."""
