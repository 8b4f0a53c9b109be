"""Light fields of one's own are captured on their own views."""

import numpy as np
import pytest

from talbot.models.capture import choose_views
from talbot.models.parameters import AmpTiming, ArrayParameters, ParameterError, SensorParameters
from talbot.models.scene import LightField, Sampling


def test_a_light_field_has_its_own_views():
    sensor = SensorParameters(array=ArrayParameters(16, 24))
    scene = LightField(np.random.default_rng(0).random((3, 3, 16, 24))).scene(Sampling.of(sensor))
    assert choose_views(scene, sensor, AmpTiming()).most == choose_views(scene, sensor, AmpTiming(), 3).most == 3
    with pytest.raises(ParameterError, match="views = 7: must be left out, the light field has its own 3"):
        choose_views(scene, sensor, AmpTiming(), 7)
