"""The look of pictures that Matplotlib draws; Matplotlib is imported where one is drawn."""

import contextlib
from collections.abc import Iterator


@contextlib.contextmanager
def own_style() -> Iterator[None]:
    """Draw with Matplotlib's defaults, whatever the user has set; what is set comes back.

    Of a `matplotlibrc` in the working folder, too, which Matplotlib reads ahead of the one that MATPLOTLIBRC names.
    """
    from matplotlib import rc_context, rcdefaults

    with rc_context():
        rcdefaults()
        yield
