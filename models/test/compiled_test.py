"""Numba's compiler, imported when it is needed; its cache: kept, and a damaged file of it is made again."""

import importlib.util
import pickle

import numpy as np
import pytest

from talbot.models.compiled import njit, vectorize

SOURCE = """
from talbot.models.compiled import njit
@njit(cache=True)
def double(x):
    return 2 * x
"""


@pytest.fixture
def stats(tmp_path):
    """What a fresh program that calls the function finds in the cache, and does not."""
    (tmp_path / "doubled.py").write_text(SOURCE)

    def called(value=3):
        spec = importlib.util.spec_from_file_location("doubled", tmp_path / "doubled.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        assert module.double(value) == 2 * value
        stats = module.double.compiled.stats
        return sum(stats.cache_hits.values()), sum(stats.cache_misses.values())

    return called


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
def test_what_is_damaged_is_compiled_again(stats, tmp_path, suffix):
    assert [stats(), stats()] == [(0, 1), (1, 0)]
    (file,) = (tmp_path / "__pycache__").glob(f"*.{suffix}")
    data = file.read_bytes()
    for damaged in (b"", data[:300], bytes(range(256)), data[:600] + bytes([data[600] ^ 1]) + data[601:]):
        file.write_bytes(damaged)
        assert [stats(), stats()] == [(0, 1), (1, 0)]


def test_an_entry_of_another_signature_is_compiled_again(stats, tmp_path):
    """As two first runs at once leave it: both names in the index, the code of one."""
    assert stats() == (0, 1)
    (index,) = (tmp_path / "__pycache__").glob("*.nbi")
    (code,) = (tmp_path / "__pycache__").glob("*.nbc")
    files = index.read_bytes(), code.read_bytes()
    index.unlink()
    assert stats(2.5) == (0, 1)
    other = index.read_bytes()
    index.write_bytes(files[0])
    assert code.read_bytes() != files[1] and other != files[0]
    assert [stats(), stats()] == [(0, 1), (1, 0)]


@njit()
def doubled(x):
    return 2 * x


@njit()
def quadrupled(x):
    return doubled(doubled(x))


@vectorize(["float64(float64)"])
def eightfold(x):
    return doubled(quadrupled(x))


def test_compiled_functions_call_one_another():
    np.testing.assert_array_equal(eightfold(np.arange(3.0)), [0, 8, 16])


def test_a_compiled_function_is_pickled_by_its_name():
    assert pickle.loads(pickle.dumps(quadrupled)) is quadrupled
