"""The Python API, `import talbot`: a module for each subject."""
