"""Pictures that scikit-image ships: as scikit-image reads them."""

import numpy as np
import pytest
from skimage import data

from talbot.models.scene import of_skimage
from talbot.models.scene.photograph import PHOTOGRAPHS


@pytest.mark.parametrize("name", PHOTOGRAPHS)
def test_photographs(name):
    np.testing.assert_array_equal(of_skimage.codes(name), getattr(data, name)())


def test_the_motorcycle():
    left, right, _ = data.stereo_motorcycle()
    np.testing.assert_array_equal(of_skimage.codes("motorcycle_left"), left)
    np.testing.assert_array_equal(of_skimage.codes("motorcycle_right"), right)


def test_a_picture_that_is_not_shipped():
    with pytest.raises(FileNotFoundError, match="no picture none"):
        of_skimage.codes("none")
