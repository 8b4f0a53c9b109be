"""Learning: its samples, a small dictionary, crops that are light fields again, and the network by PyTorch."""

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from talbot.commands import main
from talbot.flow.lightfield.learn import branches, samples, training
from talbot.models.parameters import ArrayParameters
from talbot.models.reconstruct import psnr_db
from talbot.models.reconstruct.bayes import Estimate, FieldEstimator, FieldPrior
from talbot.models.reconstruct.branches import KINDS, PATCH, Branches, Seen
from talbot.models.reconstruct.network import LAYERS, VIEWS, Network
from talbot.models.reconstruct.sparse import Dictionary

SIZE = 44
SCENE = 7  # below those that are learned from


@pytest.fixture(scope="module")
def lesson():
    with pytest.MonkeyPatch.context() as patch:  # fewer disparities: a lesson is made in a fraction of the time
        patch.setattr(samples, "FieldPrior", partial(FieldPrior, disparities=11))
        (own,) = samples.lessons([SCENE], 1, (0.006,), SIZE)
    return own


def test_a_lesson_is_what_the_mixture_lacks(lesson):
    (shot,) = samples.shots([SCENE], SIZE)
    mean, views = lesson.seen[50].astype(float), lesson.seen[25:50].astype(float)
    whole = (mean + views + lesson.wanted).reshape(shot.truth.shape)
    assert psnr_db(whole, shot.truth) > 55  # rounded to float16
    assert 0.002 < np.abs(lesson.wanted.astype(float)).mean() < 0.1


def test_crops_are_light_fields_again(lesson, monkeypatch):
    """Of a plane of known disparity every crop, mirrored or turned, shows the same disparity."""
    d, (y, x) = 1.0, np.mgrid[:SIZE, :SIZE] * 2 * np.pi / 11
    steps = np.arange(-2, 3) * d * 2 * np.pi / 11
    field = np.array([[np.sin(x + du) + np.sin(1.3 * (y + dv)) for du in steps] for dv in steps]).reshape(
        25, SIZE, SIZE
    )
    plane = samples.Lesson(
        np.concatenate([field, field, lesson.seen[50:]]).astype(np.float16), field.astype(np.float16)
    )
    rng, kinds = np.random.default_rng(0), set()
    for _ in range(12):
        _, wanted = training._crop(plane, rng)
        views = wanted.reshape(VIEWS, VIEWS, training.CROP, training.CROP)
        # View (v, u) at (y, x) is the middle one at (y + dv d, x + du d)
        np.testing.assert_allclose(views[2, 3][:, :-1], views[2, 2][:, 1:], atol=3e-3)
        np.testing.assert_allclose(views[1, 2][1:], views[2, 2][:-1], atol=3e-3)
        kinds.add(wanted[12, :3, :3].tobytes())
    assert len(kinds) > 6


def test_a_small_dictionary_by_the_command(tmp_path):
    words = ["learn", "dictionary", "--scenes=1", "--steps=3", "--atoms=20", f"--out={tmp_path / 'out'}"]
    assert main(words) == 0
    with np.load(tmp_path / "out" / "dictionary.npz") as file:
        assert file["codes"].shape == (20, *Dictionary.shipped().atoms.shape[1:])
    figures = json.loads((tmp_path / "out" / "dictionary.json").read_text())
    assert figures["errors"][-1] == figures["error"] < figures["rms"]


def test_without_pytorch_the_network_is_not_learned(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(__import__("sys").modules, "torch", None)
    assert main(["learn", "network", "--scenes=1", f"--out={tmp_path}"]) == 2
    assert "torch = not installed" in capsys.readouterr().err


@pytest.mark.parametrize(
    "word, message",
    [("--seed=-1", "seed = '-1'"), ("--scenes=x", "scenes = 'x'"), ("--start=no.npz", "start = 'no.npz'")],
)
def test_bad_arguments(word, message, capsys):
    assert main(["learn", "dictionary", word]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.needs("torch")
def test_pytorch_and_numpy_are_one_network(lesson):
    import torch

    weights, losses = training.train([lesson], 3, 1)
    assert len(losses) == 3 and set(weights) == {*LAYERS, *(f"{name}_bias" for name in LAYERS)}
    seen = lesson.seen.astype(np.float32)
    tensors = {name: torch.from_numpy(value.astype(np.float32)) for name, value in weights.items()}
    by_torch = training.forward(tensors, torch.from_numpy(seen[None]))[0].numpy()
    np.testing.assert_allclose(Network(weights)._forward(seen), by_torch, atol=1e-4)


@pytest.mark.parametrize("noise", [0.006])
def test_the_shipped_network_keeps_what_its_inputs_have_on_a_scene_that_it_has_not_seen(noise):
    (shot,) = samples.shots([SCENE - 1], 60)
    pair = samples.noisy(shot.pair, noise, np.random.default_rng(0))
    prior = FieldPrior(noise=noise, disparities=11)
    estimator = FieldEstimator(samples.sensor(60), VIEWS, prior, samples.ESTIMATED)
    linear, mixture = estimator.linear(pair), estimator.mixture(pair)
    assert isinstance(mixture, Estimate)
    own = psnr_db(Network.shipped().correct(linear, mixture, noise), shot.truth)
    assert own > psnr_db(linear, shot.truth) and own > psnr_db(mixture.light_field, shot.truth) - 0.3


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
