"""`python -m flow.formats`: token formats and scan orders compared, to build/formats/."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from tqdm import tqdm

from base.charts import save
from base.files import insert, staged
from flow.sizes.measure import ROOT, SizeError
from flow.sizes.measure import measure as size_of
from flow.tradeoff import write_csv
from models.parameters import ParameterError

from .codes import default_codes, load_codes
from .measure import THRESHOLDS, growth, measure
from .table import chart, markdown
from .tokens import FORMATS

DEFAULT_THRESHOLD = 10


def gates_of_packers():
    """NAND2 equivalents of every format's packer: dict format -> float, or None where Yosys is missing."""
    with tempfile.TemporaryDirectory(prefix="talbot-") as folder:
        result = subprocess.run(
            [
                sys.executable,
                "-m",
                "rtl.export",
                "--out",
                folder,
                *(f"--top={packer}" for _, packer in FORMATS.values()),
            ],
            cwd=ROOT,
            capture_output=True,
            text=True,
        )
        if result.returncode:
            raise SizeError(result.stderr.strip().splitlines()[-1])
        try:
            return {name: size_of(Path(folder) / f"{packer}.v", packer).gates for name, (_, packer) in FORMATS.items()}
        except SizeError as error:
            if "not found" not in str(error):
                raise
            print(f"flow.formats: sizes left out: {error}", file=sys.stderr)
            return None


def main(argv=None):
    parser = argparse.ArgumentParser(prog="python -m flow.formats", description=__doc__.splitlines()[0])
    parser.add_argument(
        "--out",
        type=Path,
        default=ROOT / "build" / "formats",
        help="folder of formats.csv, formats.md and formats.png (%(default)s)",
    )
    parser.add_argument("--codes", type=Path, help="npz with codes and ideal, both (rows, cols), in place of the scene")
    parser.add_argument("--document", type=Path, help="also put the tables between the marks of this Markdown file")
    options = parser.parse_args(argv)
    try:
        codes, ideal = load_codes(options.codes) if options.codes else default_codes()
        source = f"`{options.codes.name}`" if options.codes else "the edge codes of the default scene"
        rows = measure(codes, ideal, THRESHOLDS, lambda every: tqdm(every, desc="threshold", disable=None))
        growths = {name: growth(encoder) for name, (encoder, _) in FORMATS.items()}
        text = markdown(rows, gates_of_packers(), growths, DEFAULT_THRESHOLD, source)
        with staged(options.out) as part:
            write_csv(part / "formats.csv", rows)
            (part / "formats.md").write_text(text)
            save(chart(rows), part / "formats.png")
        if options.document:
            insert(options.document, "formats", text.split("\n", 2)[2].strip() + "\n")
    except (ParameterError, SizeError, OSError) as error:
        print(f"flow.formats: {error}", file=sys.stderr)
        return 2
    print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
