"""Render the scenes that ship with the project again, or larger, with Mitsuba 3 (pip install 'talbot[render]')."""

import json
from argparse import ArgumentParser, Namespace
from hashlib import sha256
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt

from talbot.base.arguments import Number
from talbot.models.parameters import check_choice
from talbot.models.scene.rendered import MANIFEST, RENDERED

MANTISSA = 3  # bits that are left out of a float16's: what is left is finer than the noise of the rendering
EXACT = "disparity", "depth", "behind", "bins"  # which are not noisy
WHOLE = "depth", "behind", "bins"  # which float16 is too short for

VIEWS = Number("views", "along the pupil's diameter", 1, 31, "5")
SIZE = Number("size", "rows and columns in px", 24, 1024, note="each scene's own, 96 or 128")
SAMPLES = Number("samples", "a pixel and view; four times as many for transients", 1, 10**6, "256")
SEED = Number("seed", "of the first view; each view has another", 0, 10**6, "1")
THREADS = Number("threads", "of Mitsuba", 1, 256, "1")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot render`: texts, checked by `run`."""
    add = parser.add_argument
    add("--scene", default="all", help=f"names with commas between, of {', '.join(RENDERED)} (default: all)")
    for number in (VIEWS, SIZE, SAMPLES, SEED, THREADS):
        number.add(parser)
    add("--out", default="build/render", help=f"folder for <scene>.npz and {MANIFEST}, which has their checksums")


def run(options: Namespace) -> int:
    """Render scene after scene; those that are there, made the same way, stay. Prints what was made."""
    from talbot.base.cache import digest
    from talbot.base.files import check_folder, staged
    from talbot.base.progress import Steps
    from talbot.base.sources import code
    from talbot.models.scene import Sampling

    names = list(RENDERED) if options.scene == "all" else options.scene.split(",")
    for name in names:
        check_choice("scene", name, list(RENDERED))
    views, size, samples, seed, threads = (n.value(options) for n in (VIEWS, SIZE, SAMPLES, SEED, THREADS))
    out = Path(options.out)
    check_folder("out", out)
    from talbot.imaging.render.trace import Tracer
    from talbot.imaging.render.variant import mitsuba
    from talbot.imaging.render.worlds import WORLDS

    mitsuba()  # is missed before a scene begins
    known = _manifest(out)
    with Steps(names, lines=True) as progress:
        for name in names:
            side, lens = size or RENDERED[name].size, RENDERED[name].camera
            made: dict[str, Any] = {"size": side, "views": views, "samples": samples, "seed": seed}
            made["sources"] = digest(code("talbot.imaging.render.trace"))
            progress.note(name)
            if _done(out, name, known, made):
                continue
            start = perf_counter()
            sampling = Sampling(side, side, views, lens)
            arrays = Tracer(
                WORLDS[name], sampling, samples, seed, threads, lambda what, name=name: progress.note(f"{name}: {what}")
            ).arrays()
            with staged(out) as part:
                np.savez_compressed(
                    part / f"{name}.npz", allow_pickle=False, **{k: short(k, v) for k, v in arrays.items()}
                )
                made |= {"sha256": _checksum(part / f"{name}.npz"), "by": _versions(), "command": _command(name, made)}
                known[name] = made | {"seconds": round(perf_counter() - start)}
                (part / MANIFEST).write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    for name in names:
        file = out / f"{name}.npz"
        print(f"{name}: {file.stat().st_size:,} bytes, {known[name]['seconds']} s, {file}")
    return 0


def short(name: str, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the array as the file has it: noisy arrays in fewer bits."""
    if values.dtype == bool:
        return values
    if name in WHOLE:
        return values.astype(np.float32)
    half = np.ascontiguousarray(np.asarray(values, np.float16))
    if name in EXACT:
        return half
    step = 1 << MANTISSA
    return ((half.view(np.uint16) + step // 2) & np.uint16(0xFFFF - step + 1)).view(np.float16)


def _done(out: Path, name: str, known: dict[str, Any], made: dict[str, Any]) -> bool:
    before, file = known.get(name, {}), out / f"{name}.npz"
    return all(before.get(key) == value for key, value in made.items()) and before["sha256"] == _checksum(file)


def _manifest(out: Path) -> dict[str, Any]:
    try:
        return json.loads((out / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def _checksum(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest() if file.is_file() else ""


def _command(name: str, made: dict[str, Any]) -> str:
    return f"make render SCENE={name} VIEWS={made['views']} SIZE={made['size']} SAMPLES={made['samples']}"


def _versions() -> str:
    from importlib.metadata import version

    return ", ".join(f"{name} {version(name)}" for name in ("mitsuba", "mitransient"))
