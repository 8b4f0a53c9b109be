"""One archive of a finished layout, the same to the byte: build/handoff/<design>.tar.gz."""

from argparse import ArgumentParser, Namespace
from pathlib import Path

from talbot.base.command import failures
from talbot.base.files import staged
from talbot.base.paths import RESULTS
from talbot.base.sensor import add_sensor
from talbot.flow.handoff.archive import archive, sha256
from talbot.flow.handoff.contents import Broken, contents, manifest, waived
from talbot.flow.layout.design import DESIGNS, design_asked, folder_name
from talbot.models.parameters import check_choice
from talbot.platforms.processes import PROCESSES


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `talbot handoff`."""
    parser.add_argument("--design", default="quad_divider", help=f"one of {', '.join(DESIGNS)}")
    add_sensor(parser)
    parser.add_argument("--pdk", default=PROCESSES[0], help=f"process, one of {', '.join(PROCESSES)}")
    parser.add_argument("--layouts", type=Path, default=RESULTS / "layout", help="folder of the layouts")
    parser.add_argument("--out", type=Path, default=RESULTS / "handoff", help="folder of the archive")


def run(options: Namespace) -> int:
    """Write the archive and print its hash; 1 where the layout breaks a rule that is not waived."""
    chosen = design_asked(options.design, options)
    check_choice("pdk", options.pdk, PROCESSES)
    name = folder_name(chosen, options.pdk)
    try:
        files, substitutes = contents(chosen, options.layouts / name, waived(chosen))
    except Broken as error:
        return failures(f"{chosen.name}: {line}" for line in str(error).splitlines())
    files["manifest.json"] = manifest(chosen, files, substitutes)
    with staged(options.out) as part:
        archive(part / f"{name}.tar.gz", name, files)
    path = options.out / f"{name}.tar.gz"
    print(f"{path}: {len(files)} files, sha256 {sha256(path.read_bytes())}")
    return 0
