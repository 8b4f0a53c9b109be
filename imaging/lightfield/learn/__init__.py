"""Training of the learned methods of light fields, on scenes made for it."""
