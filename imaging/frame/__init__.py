"""One frame from a scene to its report: the main job, `talbot sim`."""
