"""GDS as every step writes it: the same layout is the same file."""


def write_gds(layout, path, top=None):
    """Write a klayout.db.Layout to the file ``path``; top: klayout.db.Cell, that and what is below it alone."""
    import klayout.db as db

    options = db.SaveLayoutOptions()
    options.gds2_write_timestamps = False
    if top:
        options.select_cell(top.cell_index())
    layout.write(str(path), options)
