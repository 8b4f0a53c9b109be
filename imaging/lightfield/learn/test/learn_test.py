"""Learning: a small dictionary, and the two-branch network by PyTorch as by NumPy."""

import json
from dataclasses import replace

import numpy as np
import pytest

from talbot.commands import main
from talbot.imaging.lightfield.learn import branches, samples
from talbot.models.parameters import ArrayParameters
from talbot.models.reconstruct.branches import KINDS, PATCH, Branches, Seen
from talbot.models.reconstruct.sparse import Dictionary

SCENE = 7  # below those that are learned from


def test_a_small_dictionary_by_the_command(tmp_path):
    words = ["learn", "dictionary", "--scenes=1", "--steps=3", "--atoms=20", f"--out={tmp_path / 'out'}"]
    assert main(words) == 0
    with np.load(tmp_path / "out" / "dictionary.npz") as file:
        assert file["codes"].shape == (20, *Dictionary.shipped().atoms.shape[1:])
    figures = json.loads((tmp_path / "out" / "dictionary.json").read_text())
    assert figures["errors"][-1] == figures["error"] < figures["rms"]


def test_without_pytorch_branches_are_not_learned(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "torch", None)
    assert main(["learn", "branches", "--scenes=1", f"--out={tmp_path}"]) == 2
    assert "torch is not installed" in capsys.readouterr().err


@pytest.mark.parametrize("word, message", [("--seed=-1", "seed = '-1'"), ("--scenes=x", "scenes = 'x'")])
def test_bad_arguments(word, message, capsys):
    assert main(["learn", "dictionary", word]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.needs("torch")
def test_pytorch_and_numpy_are_one_pair_of_branches():
    import torch

    made = branches.learned([SCENE], 6, 1)
    assert set(made.summary["error"]) == {"dense", *KINDS}
    (shot,) = samples.shots([SCENE], 48)
    tile = samples.sensor().tile
    rows, cols = (PATCH + (branches.PATCHES - 1) * period for period in (tile.rows, tile.cols))
    own = replace(samples.sensor(), array=ArrayParameters(rows, cols))
    pair = shot.pair[:, :rows, :cols]
    seen = Seen(pair, own, 0.05)
    patches = seen.patches(*(np.arange(branches.PATCHES) * period for period in (tile.rows, tile.cols)))
    tensors = [
        torch.from_numpy(part[None])
        for part in (patches.reshape(branches.PATCHES, branches.PATCHES, -1), seen.back.astype(np.float32))
    ]
    for kind in KINDS:
        weights = {
            key.partition("/")[2]: torch.from_numpy(value.astype(np.float32))
            for key, value in made.weights.items()
            if key.startswith(kind)
        }
        by_torch = branches.forward(weights, kind, *tensors)[0].numpy()
        by_numpy = Branches(made.weights).estimate(pair, own, 0.05, kind) - seen.total
        np.testing.assert_allclose(by_numpy.reshape(by_torch.shape), by_torch, atol=1e-5)
