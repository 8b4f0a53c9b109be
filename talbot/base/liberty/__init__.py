"""Liberty files: a tree of groups, its text, and what is made from areas and functions alone."""
