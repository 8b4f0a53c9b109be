"""`make verify`: every step of the verification, its figures by block against their limits, and the report page."""
