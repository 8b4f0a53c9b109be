"""What a user reads of a layout: summary, limits, page, pictures, history, comparison."""
