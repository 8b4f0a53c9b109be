"""The characterizer held against a foundry's own tables, on one page."""
