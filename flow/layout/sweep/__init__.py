"""Many layouts: variants of the divider against one another, and quality against effort."""
