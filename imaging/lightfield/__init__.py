"""Light field and depth from a raw frame of the chip: `talbot lightfield`."""
