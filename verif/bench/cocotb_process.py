"""The process of a bench, for `verif.bench.simulation`: cocotb's runner builds the simulation and runs its tests."""

import sys
from pathlib import Path

from cocotb_tools.runner import get_runner

from talbot.verif.bench.simulation import BUILD_ARGS, TOP


def main(simulator: str, module: str, folder: str, results: str, seed: str, tests: str, *rest: str) -> None:
    """Build unless a complete build is kept, and run ``tests`` (names, comma-separated, or '' for all).

    rest: Verilog files, '--' and plusargs.
    """
    split = rest.index("--")
    files, plusargs = rest[:split], rest[split + 1 :]
    runner, built = get_runner(simulator), Path(folder) / "built"
    if not built.exists():
        runner.build(
            sources=list(files),
            hdl_toplevel=TOP,
            build_dir=folder,
            always=True,
            build_args=BUILD_ARGS[simulator],
            timescale=("1ns", "1ps"),
        )
        built.touch()
    runner.test(
        test_module=module,
        hdl_toplevel=TOP,
        hdl_toplevel_lang="verilog",
        build_dir=folder,
        test_dir=folder,
        results_xml=results,
        seed=seed,
        testcase=tests.split(",") if tests else None,
        plusargs=list(plusargs),
        timescale=("1ns", "1ps"),
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
