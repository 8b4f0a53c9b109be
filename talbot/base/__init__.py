"""What every floor above the models shares: files, caches, jobs, tools, steps, GDS, LEF, Liberty, pages."""
