"""The pixel of a process: gratings in its metals for the tile's types, and their response to light."""

from argparse import ArgumentParser, Namespace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from talbot.base.progress import Steps
from talbot.base.sensor import Varied, add_sensor, labelled, sensor_asked
from talbot.models.parameters import LIGHTS, ParameterError, check_choice, light
from talbot.pixels.optics.geometry import PITCHES_UM

if TYPE_CHECKING:
    from talbot.pixels.optics.geometry import PixelGeometry

# Fields of pixels.optics.geometry.PixelGeometry
METALS = {"diffraction": "metal of the upper grating", "analyzer": "metal of the lower grating, or the gates"}
NUMBERS = {
    "period_um": ("period of the gratings", 0.1, 50),
    "fill": ("share of a period that the upper lines cover", 0, 1),
    "analyzer_fill": ("share of a period that the lower lines cover", 0, 1),
    "shift": ("of the lower lines against the upper ones, in periods", -1, 1),
    "pitch_um": ("pitch of the pixels", *PITCHES_UM),
}
VARIED = Varied(
    used=("tile", "array.pitch", "optics.camera", "optics.views", "spectral"),
    limits={"array.pitch": (1e-6 * PITCHES_UM[0], 1e-6 * PITCHES_UM[1])},
)
WAVELENGTH_UM = 0.55


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot pixel`: texts, checked by `run`."""
    parser.add_argument("--pdk", default="sky130", help="process, sky130 or ihp-sg13g2")
    parser.add_argument("--heights", help="which published table of heights, where the process has several")
    parser.add_argument("--kind", default="all", help="amplitude, interleaved, photogate, or all: the best one")
    note = "of one geometry, which is solved instead of the search"
    numbers = {name: f"{said}, {low:g}..{high:g}" for name, (said, low, high) in NUMBERS.items()}
    numbers["period_um"] = f"{NUMBERS['period_um'][0]}, 0.1..half of the pitch"
    numbers["pitch_um"] += " (default: the sensor's)"
    add_sensor(parser)
    for name, said in (METALS | numbers).items():
        parser.add_argument(f"--{name.replace('_', '-')}", help=f"{said}, {note}")
    parser.add_argument("--wavelength-um", help=f"of light, 0.35..1, {note} (default: {WAVELENGTH_UM})")
    lights = ", ".join((*LIGHTS, "laser:NM"))
    parser.add_argument("--light", help=f"over which the response is averaged, one of {lights}, {note}")
    parser.add_argument(
        "--out", type=Path, help="folder for the results (default: build/pixel/<pdk>, or build/pixel/one)"
    )


def run(options: Namespace) -> int:
    """Search, write the page and print the figures; 1 where no beta of the tile can be made. Or solve one geometry."""
    from talbot.base.paths import RESULTS
    from talbot.pixels.optics.geometry import KINDS
    from talbot.pixels.response import one
    from talbot.pixels.response.job import STEPS, make
    from talbot.pixels.response.search import offered
    from talbot.platforms.optics import optical_stack

    sensor = sensor_asked(options, VARIED)
    for kind in sensor.tile.types:
        if kind.beta == 0:
            raise ParameterError("beta = 0: must be greater than 0, for gratings")
    check_choice("kind", options.kind, (*KINDS, "all"))
    stack = optical_stack(options.pdk, options.heights)
    lamp = None if options.light is None else light(options.light)
    if chosen := _one(options, sensor.array.pitch_um):
        out = options.out or RESULTS / "pixel" / labelled("one", options)
        _print_one(one.make(*chosen, out, lamp, sensor.spectral), out)
        return 0
    kinds = offered(stack, KINDS if options.kind == "all" else (options.kind,), sensor.array.pitch_um)
    out = options.out or RESULTS / "pixel" / labelled(options.pdk, options)
    with Steps(STEPS, lines=True) as steps:
        summary = make(stack, kinds, sensor, out, steps.note)
    _print(summary, out)
    return 0 if any(row["reached"] for row in summary["betas"]) else 1


def _one(options: Namespace, pitch_um: float) -> "tuple[PixelGeometry, float] | None":
    """Return the geometry and the wavelength in um; None where no option names either. Raises ParameterError."""
    from talbot.base.arguments import real
    from talbot.pixels.optics.geometry import PixelGeometry

    given = {name: getattr(options, name) for name in (*METALS, *NUMBERS) if getattr(options, name) is not None}
    if not given and options.wavelength_um is None:
        if options.light is not None:
            raise ParameterError(f"light = {options.light!r}: must be with a geometry, the search is at one wavelength")
        return None
    if options.light is not None and options.wavelength_um is not None:
        raise ParameterError(f"wavelength_um = {options.wavelength_um}: must be left out with light")
    kind = "amplitude" if options.kind == "all" else options.kind
    values: dict[str, Any] = {"analyzer": None} if kind == "interleaved" else {}
    values |= {"pitch_um": pitch_um}
    values |= {name: real(name, text, *NUMBERS[name][1:]) if name in NUMBERS else text for name, text in given.items()}
    geometry = PixelGeometry(options.pdk, kind, heights=options.heights, **values)
    text = options.wavelength_um
    return geometry, WAVELENGTH_UM if text is None else real("wavelength_um", text, 0.35, 1)


def _print_one(s: dict[str, Any], folder: Path) -> None:
    seen = f"in {s['light']}" if s["light"] else f"at {1e3 * s['wavelength_um']:.0f} nm"
    print(f"{s['process']}: {s['kind']} pixel, {_metals(s)}, period {s['period_um']:g} um, {seen}")
    print(f"  alpha {s['alpha']:.2f} rad, beta {s['beta']:.1f}, {_figures(s)}")
    print(f"  {s['wall_s']:.1f} s; look at {folder / 'response.npz'}")


def _print(s: dict[str, Any], folder: Path) -> None:
    print(f"{s['process']}: {s['kind']} pixel at {1e3 * s['wavelength_um']:.0f} nm, {s['tried']} gratings tried")
    for row in s["betas"]:
        said = "" if row["reached"] else ": not reached, the nearest is"
        print(
            f"  beta {row['wanted']:g}{said} {row['beta']:.1f}: {_metals(row)}, period {row['period_um']:g} um; "
            f"{_figures(row)}"
        )
    if s["not_drawn"]:
        print(f"  no tile.gds: {s['not_drawn']}")
    print(f"  {s['wall_s']:.0f} s; look at {folder / 'pixel.html'}")


def _metals(of: dict[str, Any]) -> str:
    return of["diffraction"] + (f" over {of['analyzer']}" if of["analyzer"] else "")


def _figures(of: dict[str, Any]) -> str:
    return (
        f"m {of['m']:.2f}, quantum efficiency {of['quantum_efficiency']:.3f}, "
        f"extinction ratio {of['extinction_ratio']:.2f}, residual of Eq. 3.1 {of['residual_rms']:.2f} rms"
    )
