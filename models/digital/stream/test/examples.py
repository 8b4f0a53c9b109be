"""The worked examples of docs/stream.md: `python -m talbot.models.digital.stream.test.examples` writes them."""

import numpy as np

from talbot.models.digital.stream import StreamHeader, encode_frame, encode_marked
from talbot.models.digital.stream.payload import base_of, code_sample, start
from talbot.models.parameters import FrameParameters, Window
from talbot.models.parameters.stream_format import FIELD_BYTES, HEADER_BYTES

FIELDS = (
    ("magic", 4),
    ("version", 1),
    ("flags", 1),
    ("threshold", 1),
    ("lanes", 1),
    ("tile", 1),
    ("rows", 2),
    ("cols", 2),
    ("row0", 1),
    ("row1", 1),
    ("col0", 1),
    ("col1", 1),
    ("mask", 3),
    ("frame number", 2),
    ("exposure", 2),
    ("n_cm", 1),
    ("t_int", 2),
    ("calibration", 1),
    ("CRC-32", 4),
)


def token_lines(codes, base):
    """A line for each token of a row: the state before it, its meaning, its bits."""
    state, lines = start(base), []
    for code in codes:
        k, r2, run, credit = state
        bits, length, *state = code_sample(int(code), base, *state)
        if not length:
            continue
        text = f"{bits:0{length}b}"
        q = k // 4
        if base and run == 0 and credit // 4 < q + 16:
            said = f"literal {code}"
        elif q == 0:
            said = f"{code}"
        elif text == "0":
            said = f"{1 << q - 1} zeros"
        else:
            said = f"{run} zeros, then {code}"
            text = " ".join(filter(None, (text[0], text[1:q], text[q:])))
        lines.append(_token(k, r2, credit, said, text))
    k, r2, run, credit = state
    return lines + [_token(k, r2, credit, f"{run} zeros, the end", "0")] * (run > 0)


def _token(k, r2, credit, said, text):
    return f"  k={k:<2} r2={r2} credit={credit:<4} {said:22} {text}"


def row_example(row, codes, threshold, mode="edge"):
    """A row of edge or ternary mode, token by token, and its bytes."""
    base = base_of(mode, threshold)
    sent = encode_marked(row, codes, True, base)
    return [
        f"a segment of {mode} mode from row {row} on, threshold {threshold}, {len(codes)} samples:",
        "  " + " ".join(map(str, codes)),
        "tokens:",
        *token_lines(codes, base),
        f"payload: {sent[:-2].hex(' ')}",
        f"mark:    {sent[-2:].hex(' ')}",
    ]


def frame_example(header, samples, made, left_out):
    """A whole frame, field by field."""
    data = encode_frame(header, samples, made, left_out)
    lines, at = [], 0
    for name, size in FIELDS:
        lines.append(f"{name:14}{data[at : at + size].hex(' ')}")
        at += size
    assert at == HEADER_BYTES == FIELD_BYTES + 4
    layout = header.layout()
    for i, row in enumerate(layout.rows.tolist()):
        codes = samples.reshape(header.rows, -1)[row, layout.places_of(i)]
        size = len(encode_marked(row, codes, *header.coder))
        payload, mark = data[at : at + size - 2], data[at + size - 2 : at + size]
        lines.append(f"{f'row {row}':14}{payload.hex(' ')}   mark {mark.hex(' ')}")
        at += size
    for name, size in (("made", 4), ("left out", 4), ("mark", 2), ("CRC-32", 4)):
        lines.append(f"{name:14}{data[at : at + size].hex(' ')}")
        at += size
    assert at == len(data)
    return lines


def edges():
    """Return a segment with runs, values of both signs, a long run, and a run that ends with the segment."""
    return row_example(5, [0] * 5 + [12, 0, 0, -10, 15, -31] + [0] * 14 + [10] + [0] * 7, 10)


def faint():
    """Return a segment under the noise: tokens of single samples, zeros among them."""
    return row_example(8, [-1, 1, -2, 0, 1, -1, 3, -1, -2, 0, -3, 0], 1)


def noise():
    """Return a segment that does not compress: literals follow when the credit is used up."""
    return row_example(0, [-128, 127, -128, 127, -128, 0], 0)


def signs():
    """Return a segment of ternary mode: a run, neighbours of both signs, zeros at its end."""
    return row_example(2, [0] * 9 + [1, -1, -1, 1, 0, 0, 1, 0, 0, 0], 10, "ternary")


def small_frame():
    """A raw frame of 2 x 6 pixels, type 3 masked."""
    frame = FrameParameters(
        Window(0, 0, 0, 0), "raw", mask=0xFFFFF7, threshold=10, frame_number=258, resync=0, calibration=7
    )
    header = StreamHeader.from_frame(2, 6, 1, frame)
    return frame_example(header, np.arange(24).reshape(2, 6, 2) * 10, 22, 0)


DOCUMENTED = edges  # in docs/stream.md
FURTHER = faint, noise, signs

if __name__ == "__main__":
    print("\n\n".join("\n".join(example()) for example in (DOCUMENTED, small_frame, *FURTHER)))
