"""From a task to a sensor: the keys of sensor.toml searched for the front of error and costs: `talbot explore`."""
