"""Programs on test chip 1: the sensor's stream decoded there, sorting, and their cycles."""
