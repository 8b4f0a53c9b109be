"""Recognition on what the sensor sends: `talbot recognize`."""
