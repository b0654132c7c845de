"""Memory and checkpoints of a long run: ``python -m validation.soak.run --output SCRATCH_FOLDER``.

Runs the tank of still water for 35 s in a separate process, with a checkpoint every 10 s of wall-clock time, and
samples the memory of that process every 10 s.
"""

import argparse
import subprocess
import sys
import time
from pathlib import Path

RUN = """
import sys, sphframe
sphframe.run("hydrostatic-tank", until={until}, checkpoint_every=10.0, output=sys.argv[1], threads={threads})
"""


def resident(process: int) -> int:
    """Return the resident memory of ``process``, kB (Linux)."""
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return int(next(line.split()[1] for line in lines if line.startswith("VmRSS")))


def main() -> None:
    """Run, sample and print the growth after the first minute."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, required=True, help="scratch folder for the run")
    parser.add_argument("--threads", type=int, default=1, help="threads of the run")
    parser.add_argument("--until", type=float, default=35.0, help="simulated time, s")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    output = arguments.output / "tank.nc"
    program = RUN.format(until=arguments.until, threads=arguments.threads)
    command = [sys.executable, "-c", program, str(output)]
    began, samples, checkpoints = time.monotonic(), [], set()
    with (arguments.output / "log.txt").open("w") as log, subprocess.Popen(command, stdout=log, stderr=log) as process:
        while process.poll() is None:
            time.sleep(10.0)
            if process.poll() is None:
                samples.append((time.monotonic() - began, resident(process.pid)))
                restart = output.with_name(output.name + ".restart")
                checkpoints.update([restart.stat().st_mtime] if restart.exists() else [])
    late = [
        memory for at, memory in samples[:-1] if at >= 60.0
    ]  # without the last, which may be that of opening the result
    print(f"exit code {process.returncode} after {time.monotonic() - began:.0f} s, {len(checkpoints)} checkpoints seen")
    print(f"memory after the first minute {late[0] / 1024:.1f} MiB, at most {max(late) / 1024:.1f} MiB after it")
    print(f"growth {100.0 * (max(late) / late[0] - 1.0):.2f} %")


if __name__ == "__main__":
    main()
