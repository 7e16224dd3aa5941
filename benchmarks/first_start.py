"""Time of a first start, with no compiled kernels: commands in all, and kernels one by one.

    python benchmarks/first_start.py [--kernels 25] [--only demo map movie]

For each command prints seconds on the clock and of all processors, with an empty folder for kernels and with
the filled one. Then, for the run of a movie in one process, processor seconds of each kernel (without the
kernels that it calls) and its number of signatures. Ends with status 1 if `map` or `movie` takes longer than
15 s with the empty folder, which holds for two free cores.
"""

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import tifffile
from numba.core import event

import cytodisk as cd

COMMANDS = {
    "demo": ["demo", "-o", "demo"],
    "map": ["map", "masks.tif", "-o", "map"],
    "movie": ["movie", "masks.tif", "-o", "movie"],
}
MOST_S = 15.0  # of a first start of map or movie
ARGUMENTS = ["--overwrite", "--quiet"]


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--kernels", type=int, default=25, help="How many to print, the longest first.")
    parser.add_argument("--only", nargs="*", default=list(COMMANDS), choices=COMMANDS)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.inside:
        print_kernels(given.kernels)
        return 0
    met = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        masks = cd.simulate.movie("growing", frames=3, radius_px=16.0).masks.astype("uint8")
        tifffile.imwrite(folder / "masks.tif", masks, metadata={"axes": "TYX"}, imagej=True)
        for command in given.only:
            for state in ("empty", "filled"):
                words = [sys.executable, "-m", "cytodisk", *COMMANDS[command], *ARGUMENTS]
                clock, processor = timed(words, folder, command)
                line = f"{command}, {state} folder: {clock:.1f} s, {processor:.1f} s of processors"
                if state == "empty" and command != "demo":  # which does much else
                    met = met and clock <= MOST_S
                    line += f", at most {MOST_S:.0f} s: {'met' if clock <= MOST_S else 'NOT MET'}"
                print(line, flush=True)
        words = [sys.executable, __file__, "--inside", "--kernels", str(given.kernels)]
        timed(words, folder, "kernels")
    return 0 if met else 1


def timed(words: list[str], folder: Path, cache: str) -> tuple[float, float]:
    """Seconds on the clock and of all processors that a command takes."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(folder / f"{cache}_kernels")}
    clock, processor = time.perf_counter(), _children_seconds()
    subprocess.run(words, env=environment, cwd=folder, check=True)
    return time.perf_counter() - clock, _children_seconds() - processor


def print_kernels(most: int) -> None:
    """Compile what the run of a movie needs in this process, and print what took long."""
    watch = Watch()
    event.register("numba:compile", watch)
    cd.run_movie("masks.tif", "kernels")
    print(f"kernels of a movie in one process: {sum(watch.seconds.values()):.1f} s of processor")
    print(f"of these NumPy's and Python's own functions: {watch.of_numba():.1f} s")
    ours = [(name, seconds) for name, seconds in watch.seconds.most_common() if name.startswith("cytodisk.")]
    for name, seconds in ours[:most]:
        print(f"{seconds:6.2f} s  {watch.signatures[name]} signature(s)  {name.removeprefix('cytodisk.')}")


class Watch(event.Listener):
    """Takes the time of each compilation, without those within it."""

    def __init__(self) -> None:
        self.seconds: Counter[str] = Counter()
        self.signatures: Counter[str] = Counter()
        self._running: list[list[float]] = []  # start, and seconds of those within

    def on_start(self, event: event.Event) -> None:
        self._running.append([time.process_time(), 0.0])

    def on_end(self, event: event.Event) -> None:
        start, within = self._running.pop()
        whole = time.process_time() - start
        if self._running:
            self._running[-1][1] += whole
        kernel = event.data["dispatcher"].py_func
        name = f"{kernel.__module__}.{kernel.__qualname__}"
        self.seconds[name] += whole - within
        self.signatures[name] += 1

    def of_numba(self) -> float:
        """Seconds for functions that are not this project's."""
        return sum(seconds for name, seconds in self.seconds.items() if not name.startswith("cytodisk."))


def _children_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    sys.exit(main())
