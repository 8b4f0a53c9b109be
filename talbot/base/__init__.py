"""Infrastructure of all layers above the models: files, caches, jobs, tools, steps, GDS, LEF, Liberty, pages."""
