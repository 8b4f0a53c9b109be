"""The steps of the sensor's die, each in the file of its name."""
