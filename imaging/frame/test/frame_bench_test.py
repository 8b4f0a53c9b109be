"""Speed of whole frames in the simulator: cycles a second, and how near the bench is to a bare clock loop."""

import json
import subprocess

from talbot.imaging.frame import hardware, job
from talbot.imaging.frame.request import request
from talbot.imaging.simulate.build import Build
from talbot.imaging.simulate.frame import host_script
from talbot.imaging.simulate.verilator import bare_program
from talbot.models.digital.host import command, frame_writes, write_transfers
from talbot.models.parameters import FrameParameters

ROUNDS = 7


def best(run):
    return max(run() for _ in range(ROUNDS))


def test_default_frame(benchmark, tmp_path):
    """extra_info: cycles/s of the whole bench, of the chip alone in a bare loop, and the ratio of their times."""
    asked = request()
    scene, todo = job.see(asked)
    exposed = job.expose(asked, scene, todo)
    program = hardware.program(asked.sensor)

    def frame():
        run = hardware.simulate(program, asked.sensor, asked.frame, exposed.samples, exposed.front_end)
        return run.cycles / run.seconds

    script = tmp_path / "script"
    pattern = FrameParameters(asked.frame.window, test_pattern=True)
    script.write_bytes(host_script(write_transfers(frame_writes(pattern)) + [command("start")], []))
    alone = bare_program(Build.of(asked.sensor))

    def bare():
        found = json.loads(subprocess.run([alone, f"+script={script}"], capture_output=True, check=True).stdout)
        return found["cycles"] / found["seconds"]

    bench_speed, bare_speed = best(frame), best(bare)
    benchmark.extra_info.update(
        bench_cycles_per_s=bench_speed, bare_cycles_per_s=bare_speed, bare_over_bench=bare_speed / bench_speed
    )
    print(
        f"\nbench {bench_speed / 1e6:.2f} M cycles/s, bare {bare_speed / 1e6:.2f}, ratio {bare_speed / bench_speed:.2f}"
    )
    benchmark(frame)
