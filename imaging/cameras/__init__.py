"""Other cameras on the same scenes, pixels, lens, light and noise: `talbot cameras`."""
