"""The real-number Verilog against its NumPy model, sample for sample, in Verilator and in Icarus."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from talbot.base.verilator import compile_program, runtime, verilate
from talbot.models.afe import Converter, FrontEnd, write_converter, write_samples
from talbot.models.parameters import MODES, ConverterParameters, TileParameters

HERE = Path(__file__).parent
SOURCES = HERE.parent / "afe.sv", HERE / "lanes.sv"
TAPS, ROWS, COLS, LANES = 4, 9, 20, 2  # partial tiles at both far edges; lanes.sv has the same by default

RNG = np.random.default_rng(11)
TRIM = tuple(RNG.integers(-512, 512, 24).tolist())
ROUGH = Converter.draw(
    ConverterParameters(
        inl=2,
        dnl=0.5,
        offset=3,
        noise=1.5,
        ktc=1,
        amplifier_offset=0.4,
        amplifier_gain=-3,
        amplifier_square=0.7,
        amplifier_cube=-1.3,
        seed=2**32 - 5,
    ),
    LANES,
)
SAMPLES = RNG.uniform(0, 127.5, (TAPS, ROWS, COLS, 2))
SAMPLES[:, :4, :, 1] = SAMPLES[:, :4, :, 0] + RNG.normal(0, 2, (TAPS, 4, COLS))  # some for the zero window


@pytest.fixture(scope="module")
def verilated(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lanes")
    model = verilate(folder / "model", "Lanes", SOURCES, ["-O3", "--no-timing", "-Wno-lint"])
    compile_program(folder / "lanes", [*model, HERE / "lanes.cpp"], ["-O0", "-ffp-contract=off", *runtime()])
    return [folder / "lanes"]


@pytest.fixture(scope="module")
def interpreted(tmp_path_factory, require):
    require("iverilog")
    program = tmp_path_factory.mktemp("lanes") / "lanes.vvp"
    subprocess.run(["iverilog", "-g2012", "-s", "Clock", "-o", program, *SOURCES], check=True)
    return ["vvp", program]


def run(program, folder, front_end, mode, threshold, samples=SAMPLES):
    """Codes and converted flags, int64 (subs, rows, cols) each; -999 where nothing was printed."""
    write_samples(folder / "samples", samples)
    write_converter(folder / "converter", front_end)
    by_position = np.array(front_end.trim)[list(TileParameters().order)]
    (folder / "trim").write_text("\n".join(f"{t & 0x3FF:x}" for t in by_position))
    result = subprocess.run(
        [
            *program,
            f"+mode={MODES.index(mode)}",
            f"+threshold={threshold}",
            *(f"+{name}={folder / name}" for name in ("samples", "converter", "trim")),
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    row, col, sub, code, converted = np.loadtxt(
        [line for line in result.stdout.splitlines() if line[:1].isdigit()], dtype=np.int64
    ).T
    out = np.full((2, {"raw": 2, "tof": 4}.get(mode, 1), ROWS, COLS), -999)
    out[0, sub, row, col], out[1, sub, row, col] = code, converted
    return out


@pytest.mark.parametrize("simulator", ["verilated", "interpreted"])
@pytest.mark.parametrize(
    "mode, threshold", [("edge", 6), ("edge", 0), ("edge", 127), ("image", 6), ("raw", 0), ("tof", 0)]
)
def test_agrees_with_numpy_with_every_imperfection_on(request, tmp_path, simulator, mode, threshold):
    front_end = FrontEnd(gain=3.7, trim=TRIM, lanes=LANES, converter=ROUGH)
    codes, converted = run(request.getfixturevalue(simulator), tmp_path, front_end, mode, threshold)
    expected = front_end.convert(SAMPLES, mode, threshold)
    assert (codes == expected.codes).all()
    assert (converted == expected.converted).all()
    if threshold == 6 and mode == "edge":
        assert converted.any() and not converted.all()


@pytest.mark.parametrize("simulator", ["verilated", "interpreted"])
def test_agrees_with_numpy_when_ideal(request, tmp_path, simulator):
    front_end = FrontEnd(gain=4.0, trim=(0,) * 24, lanes=LANES)
    halves = np.round(SAMPLES * 8) / 8  # many values exactly at a level
    for mode in ("edge", "image"):
        codes, _ = run(request.getfixturevalue(simulator), tmp_path, front_end, mode, 10, halves)
        assert (codes == front_end.convert(halves, mode, 10).codes).all()


@pytest.mark.parametrize("broken, message", [("samples", "not whole taps"), ("converter", "number of lanes")])
def test_refuses_files_that_are_too_short(verilated, tmp_path, broken, message):
    front_end = FrontEnd(gain=1.0, trim=(0,) * 24, lanes=LANES)
    write_samples(tmp_path / "samples", SAMPLES)
    write_converter(tmp_path / "converter", front_end)
    (tmp_path / "trim").write_text("0\n" * 24)
    os.truncate(tmp_path / broken, (tmp_path / broken).stat().st_size - 8)
    result = subprocess.run(
        [
            *verilated,
            "+mode=0",
            "+threshold=0",
            *(f"+{name}={tmp_path / name}" for name in ("samples", "converter", "trim")),
        ],
        capture_output=True,
        text=True,
    )
    assert result.returncode and message in result.stdout + result.stderr
