"""A bench's own process, for `verif.bench.simulation`: cocotb's runner builds the simulation and runs its tests."""

import sys
from pathlib import Path

from cocotb_tools.runner import get_runner

from .simulation import BUILD_ARGS, TOP


def main(simulator, module, folder, results, seed, tests, *rest):
    """tests: names, comma-separated, or '' for all. rest: Verilog files, '--' and plusargs.

    A build is kept: it is marked when it is whole.
    """
    cut = rest.index("--")
    files, plusargs = rest[:cut], rest[cut + 1 :]
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
