"""Scenes by Mitsuba 3: light fields, depth, Stokes parameters, time of flight; no formula of ours made them."""
