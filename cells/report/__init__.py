"""The page that compares the characterizer with a foundry's tables."""
