"""Time of `map_to_disk`: warm, against a yardstick, against size, and in a fresh process."""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import tifffile
from scipy import sparse
from scipy.sparse.linalg import splu

from cytodisk import simulate
from cytodisk.arrays import BoolArray
from cytodisk.disk.mapping import map_to_disk

_DEFAULT_DATA = Path(__file__).parents[2] / "shared" / "data"
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
_FIRST_CALL = """
import time
start = time.perf_counter()
import cytodisk
loaded = time.perf_counter()
from cytodisk.disk.mapping import map_to_disk
import numpy as np
map_to_disk(np.ones((40, 40), dtype=bool)).to_disk([[20.0, 20.0]])
print(loaded - start, time.perf_counter() - loaded)
"""


def restart_with_one_thread() -> None:
    """Start this script anew unless it is held to one thread: the libraries ask when they are loaded."""
    if any(os.environ.get(name) != "1" for name in THREADS):
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | dict.fromkeys(THREADS, "1"))


def median_seconds(
    call: Callable[[], object], repeats: int, clock: Callable[[], float] = time.perf_counter
) -> float:
    """Median time of a call, after one that does not count."""
    call()
    seconds = []
    for _ in range(repeats):
        start = clock()
        call()
        seconds.append(clock() - start)
    return float(np.median(seconds))


def yardstick() -> Callable[[], object]:
    """Factorise the 5-point Laplacian of a 200 × 200 grid: the same work on every machine."""
    second = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(200, 200))
    one = sparse.eye_array(200)
    laplacian = sparse.csc_matrix(sparse.kron(second, one) + sparse.kron(one, second))
    return lambda: splu(laplacian)


def twice_as_large(mask: BoolArray) -> BoolArray:
    """Every pixel drawn as 2 × 2 pixels."""
    return mask.repeat(2, axis=0).repeat(2, axis=1)


def doubling(
    data: Path, repeats: int, clock: Callable[[], float] = time.perf_counter
) -> Iterator[tuple[str, float, float, list[int]]]:
    """Each shape's name, its seconds, those when it is drawn twice as large, and Newton steps of both."""
    pairs = {
        "disk": (simulate.disk(40.0), simulate.disk(80.0)),
        "ellipse": (simulate.ellipse((16.0, 80.0)), simulate.ellipse((32.0, 160.0))),
        "star": (
            simulate.star(body_radius=25.0, arm_length=40.0, arm_width=6.0),
            simulate.star(body_radius=50.0, arm_length=80.0, arm_width=12.0),
        ),
        "smooth": (simulate.random_smooth(radius=40.0), simulate.random_smooth(radius=80.0)),
    }
    for path in sorted((data / "reference_masks").glob("*.tif")):
        mask = tifffile.imread(path) > 0
        pairs[path.stem + " ×2"] = mask, twice_as_large(mask)
    for name, (small, large) in pairs.items():
        before = median_seconds(lambda small=small: map_to_disk(small), repeats, clock)
        after = median_seconds(lambda large=large: map_to_disk(large), repeats, clock)
        yield name, before, after, [map_to_disk(mask).steps for mask in (small, large)]


def print_doubling(data: Path, repeats: int) -> None:
    """Print what the same shape costs when it is drawn twice as large."""
    print(f"\n{'shape':<18}{'seconds':>9}{'twice as large':>16}{'ratio':>7}{'steps':>7}{'then':>6}")
    for name, before, after, steps in doubling(data, repeats):
        print(f"{name:<18}{before:>9.3f}{after:>16.3f}{after / before:>7.2f}{steps[0]:>7}{steps[1]:>6}")


def print_fresh_process() -> None:
    """Print the import time and the time of the first call with an empty and with a filled kernel cache."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        for state in ("empty", "filled"):
            run = subprocess.run(
                [sys.executable, "-c", _FIRST_CALL],
                env=environment,
                capture_output=True,
                text=True,
                check=True,
            )
            loading, first = (float(word) for word in run.stdout.split())
            print(
                f"fresh process, {state} kernel cache: import {loading:.3f} s, then first call {first:.2f} s"
            )


def main() -> int:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=15, help="timed calls of each kind (default 15)")
    parser.add_argument(
        "--data",
        type=Path,
        default=Path(os.environ.get("CYTODISK_DATA", _DEFAULT_DATA)),
        help="folder that holds reference_masks/",
    )
    arguments = parser.parse_args()
    restart_with_one_thread()
    example = arguments.data / "reference_masks" / "example.tif"
    if example.exists():
        mask, name = tifffile.imread(example) > 0, "example"
    else:
        mask, name = simulate.cell_with_signal().mask, "simulated cell"
    seconds = median_seconds(lambda: map_to_disk(mask), arguments.repeats)
    unit = median_seconds(yardstick(), arguments.repeats)
    print(f"map_to_disk on {name}, warm, one thread: {seconds:.3f} s (median of {arguments.repeats})")
    print(f"yardstick (splu of a 200 × 200 Laplacian): {unit:.3f} s; ratio {seconds / unit:.2f}")
    print_doubling(arguments.data, max(3, arguments.repeats // 3))
    print_fresh_process()
    return 0


if __name__ == "__main__":
    sys.exit(main())
