"""The documents site: READMEs, docs/, the API, and pages generated from the code (`make site`)."""
