"""What `import talbot` offers, a module for each subject."""
