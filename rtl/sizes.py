"""The values with which a block can be built: each is proven, or tested for every size (verif.formal.sizes)."""

from collections.abc import Sequence

from talbot.models.parameters import (
    COLS_MAX,
    DIVIDERS,
    LANES,
    NO_DIVIDER,
    ROWS_MAX,
    TileParameters,
    check_choice,
    check_int,
)
from talbot.models.parameters.divider import ITERATIONS_MAX, ITERATIONS_MIN, N_FRAC_MAX, N_FRAC_MIN

BUILD: dict[str, range | tuple[object, ...]] = {
    "rows": range(1, ROWS_MAX + 1),
    "cols": range(1, COLS_MAX + 1),
    "lanes": LANES,
    "tile_rows": range(1, TileParameters().rows + 1),
    "tile_cols": range(1, TileParameters().cols + 1),
    "divider": DIVIDERS,
    "n_frac": range(N_FRAC_MIN, N_FRAC_MAX + 1),
    "iterations": range(ITERATIONS_MIN, ITERATIONS_MAX + 1),
}
# A chip, and its registers, can do without the phase path
CHIP: dict[str, range | tuple[object, ...]] = BUILD | {"divider": (*DIVIDERS, NO_DIVIDER)}
BLOCKS = {"AspChip": CHIP, "RegFile": CHIP}  # others: BUILD


def check_size(block: str = "", **values: object) -> None:
    """Check the parameters with which ``block`` is built, by their names in BUILD. Raises ParameterError."""
    for name, value in values.items():
        allowed = BLOCKS.get(block, BUILD)[name]
        if isinstance(allowed, range):
            check_int(name, value, allowed[0], allowed[-1])
        else:
            check_choice(name, value, allowed)


def check_tile(order: Sequence[int], tile_rows: int, tile_cols: int) -> None:
    """Check the tile with which a block is built: a permutation of its pixel types. Raises ParameterError."""
    check_size(tile_rows=tile_rows, tile_cols=tile_cols)
    TileParameters(tile_rows, tile_cols, TileParameters().types[: tile_rows * tile_cols], tuple(order))
