"""Responses in a file: those of a bench there and back, those of `make pixel` across and along the lines."""

import numpy as np
import pytest

from talbot.models.parameters import ParameterError, PixelType
from talbot.models.pixel import TableResponse
from talbot.pixels.measured import read_responses, write_responses

KINDS = PixelType(12, 0, 0), PixelType(24, 45, np.pi / 2)


def test_of_a_bench(tmp_path):
    rng = np.random.default_rng(0)
    along, across = np.linspace(-0.4, 0.4, 9), np.linspace(0, 0.4, 5)
    tables = [TableResponse(along, across, rng.uniform(0, 1, (2, 9, 5)), kind.gamma, "") for kind in KINDS]
    path = str(tmp_path / "response.npz")
    write_responses(tmp_path / "response.npz", ["a", "b"], tables, 575e-9)
    for kind, table in zip(read_responses(path, KINDS, "PIXEL="), tables, strict=True):
        assert isinstance(kind.response, TableResponse) and kind.response.source == f"PIXEL={path}"
        np.testing.assert_array_equal(kind.response.values, table.values)
    with np.load(path) as file:
        assert file["response"].shape == (2, 2, 9, 1, 1) and file["wavelengths"] == 575e-9
    with pytest.raises(ParameterError, match="it has 2 types, the sensor 1"):
        read_responses(path, KINDS[:1], "")


def test_of_make_pixel(tmp_path):
    angles = np.deg2rad(np.linspace(-20, 20, 41))
    curves = np.stack([1 + 0.5 * np.cos(12 * angles), 1 - 0.5 * np.cos(12 * angles)])
    response = np.broadcast_to(curves[None, :, :, None, None], (2, 2, 41, 3, 2))
    np.savez(tmp_path / "response.npz", response=response, angles=angles, wavelengths=[5e-7, 5.5e-7, 6e-7])
    kinds = read_responses(str(tmp_path / "response.npz"), KINDS, "PIXEL=")
    assert kinds[0].response is not None
    np.testing.assert_allclose(kinds[0].response(angles, 0 * angles), curves, atol=1e-3)
    assert np.abs(kinds[0].response(angles, 0 * angles + 0.3) - curves).max() < 0.1  # light aslant walks hardly less


@pytest.mark.parametrize(
    "arrays, said",
    [
        ({"angles": [0.0]}, "it has no response"),
        ({"response": np.ones((2, 4, 1, 2)), "angles": [0.0], "wavelengths": [5e-7]}, "has the shape .2, 4, 1, 2."),
        ({"response": np.array([None]), "angles": [0.0], "wavelengths": [0.0]}, "Object arrays cannot be loaded"),
    ],
)
def test_refused(tmp_path, arrays, said):
    np.savez(tmp_path / "response.npz", **arrays)
    with pytest.raises(ParameterError, match=said):
        read_responses(str(tmp_path / "response.npz"), KINDS, "")


def test_no_such_file(tmp_path):
    (tmp_path / "text.npz").write_text("no archive")
    for name in ("none.npz", "text.npz"):
        with pytest.raises(ParameterError, match=f"{name}': must be a response.npz of talbot pixel"):
            read_responses(str(tmp_path / name), KINDS, "")
