import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from talbot.models.digital.stream import encode_payload
from talbot.models.digital.stream.payload import TOKEN_MAX, base_of, code_sample, decode_segment, row_bytes_max, start

CODES = st.lists(st.one_of(st.just(0), st.integers(-128, 127), st.integers(-3, 3)), max_size=300)


def decoded(payload, count, edge, base, lead=3):
    """Decode a payload between other bytes: (bytes used, codes)."""
    data = np.frombuffer(b"\xa5" * lead + payload + b"\x5a" * 7, np.uint8)
    where, value = np.empty(count, np.int32), np.empty(count, np.int16)
    coder = edge, base, 0, where, value
    end, _, found, _ = decode_segment(data, lead, data.size, 0, np.array([count], np.int32), *coder)
    codes = np.zeros(count, int)
    codes[where[:found]] = value[:found]
    return end - lead, codes.tolist()


@settings(max_examples=300, deadline=None)
@given(CODES, st.integers(0, 127))
def test_edge_payload_comes_back_and_delimits_itself(codes, threshold):
    kept = [code if abs(code) >= threshold else 0 for code in codes]
    base = base_of("edge", threshold)
    payload = encode_payload(codes, True, base)
    assert decoded(payload, len(codes), True, base) == (len(payload), kept)


@settings(max_examples=200, deadline=None)
@given(st.lists(st.sampled_from([0, 0, 0, 1, -1]), max_size=300), st.integers(0, 60))
def test_ternary_payload_comes_back_and_delimits_itself(codes, zeros):
    codes += [0] * zeros * zeros
    payload = encode_payload(codes, True, 0)
    assert decoded(payload, len(codes), True, 0) == (len(payload), codes)
    assert len(payload) <= (2 * len(codes) + 8) / 8 + 1


@settings(max_examples=50, deadline=None)
@given(st.lists(st.integers(0, 255), max_size=100))
def test_other_modes_are_plain_bytes(codes):
    assert encode_payload(codes, False, 9) == bytes(codes)
    assert decoded(bytes(codes), len(codes), False, 9)[0] == len(codes)
    assert decoded(bytes(codes), len(codes) + 8, False, 9)[0] < 0


@settings(max_examples=200, deadline=None)
@given(CODES, st.integers(0, 127))
def test_no_row_grows_beyond_its_bound(codes, threshold):
    assert len(encode_payload(codes, True, base_of("edge", threshold))) <= row_bytes_max(len(codes), True)


@pytest.mark.parametrize("seed", range(4))
def test_incompressible_rows_grow_by_less_than_a_sixteenth(seed):
    rng = np.random.default_rng(seed)
    noise = [
        rng.integers(-128, 128, 384),
        rng.choice([-128, 127], 384),
        rng.choice([-128, 0, 127], 384),
        np.tile([0, 0, 0, -128], 96),
    ][seed]
    assert len(encode_payload(noise, True, 1)) + 2 <= 384 * 17 / 16


def test_worst_case_chosen_sample_by_sample():
    """An adversary who knows the coder's state and takes whichever sample costs most bits."""
    state, codes, bits = start(1), [], 0
    for _ in range(2000):
        options = [(code_sample(code, 1, *state), code) for code in (-128, 127, 1, -1, 2, 10, 0)]
        (_, length, *state), code = max(options, key=lambda option: option[0][1])
        assert length <= TOKEN_MAX and state[3] >= 0
        bits += length
        codes.append(code)
    assert 8.2 * 2000 < bits <= 8.25 * 2000 + 32
    assert len(encode_payload(codes, True, 1)) == -(-bits // 8)


def test_worst_case_of_ternary():
    """Zeros up to the highest order, then signs; after each run the adversary takes whichever costs most."""
    for order in range(1, 13):
        state, bits, samples = start(0), 0, 0
        while state[0] < 4 * order:
            _, length, *state = code_sample(0, 0, *state)
            bits, samples = bits + length, samples + 1
        for _ in range(20):
            _, length, *state = code_sample(-1, 0, *state)
            bits, samples = bits + length, samples + 1
        assert bits <= 2 * samples + 4


def test_payload_that_no_encoder_writes_is_refused():
    """A value beyond 127, a run beyond the row, bits after the end, and a payload cut short."""
    row = [0] * 9 + [100] + [0] * 20
    payload = encode_payload(row, True, 1)
    assert decoded(payload, 30, True, 1)[0] == len(payload)
    assert decoded(payload, 30, True, 60)[0] < 0  # 100 above a base of 60
    assert decoded(payload, 9, True, 1)[0] < 0  # the value is out of range
    assert decoded(payload[:-1] + bytes([payload[-1] | 1]), 30, True, 1)[0] < 0
    where, value = np.empty(30, np.int32), np.empty(30, np.int16)
    data = np.frombuffer(payload, np.uint8)
    assert decode_segment(data, 0, data.size - 1, 0, np.array([30], np.int32), True, 1, 0, where, value)[0] < 0
