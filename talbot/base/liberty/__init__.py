"""Liberty files: a tree of groups, its text, and libraries from areas and functions alone."""
