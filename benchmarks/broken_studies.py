"""Break studies and resume them: what comes out must be what an undisturbed run writes, or a refusal.

    benchmarks/broken_studies.py [--count N] [--first SEED] [--results FILE]

Each case is one run of `map`, `movie`, `shapes`, `compare-windows` or `batch` that is killed, or meets a full
disk, at one of the points where it opens, renames or removes a file, or that ends well; then a file of it is
removed, cut, changed or emptied, a part is added, an input changes, or nothing more happens; then it is
resumed. All that a case does follows from its seed. With `--results`, cases are written to the file, and a
benchmark that was stopped goes on where it was. Prints a table with a row a kind; ends with status 1 if a
result differed, or ended in anything but a `CytodiskError`.
"""

from __future__ import annotations

import argparse
import errno
import json
import multiprocessing
import os
import shutil
import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import tifffile

import cytodisk as cd
from cytodisk.errors import CytodiskError, StudyError

RUNS = ("map", "movie", "shapes", "compare", "batch")
BREAKS = ("killed", "full disk", "complete")
HARMS = ("none", "removed", "cut", "changed", "emptied", "extra part", "changed input")
SAME, REFUSED, DIFFERENT, FAILED = "same", "refused", "different", "failed"
_SMALL: dict[str, Any] = {"layers": 2, "sectors": 6}
_POINTS = ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir")
_TIME_S = 600.0  # of a run, which compiles kernels if it is the first
_BATCH = """[parameters]
layers = 2
sectors = 6
[[inputs]]
masks = "movie.tif"
[[inputs]]
masks = "cells.tif"
kind = "map"
"""


@dataclass(frozen=True)
class Case:
    """One study that was broken, and what came of it."""

    seed: int
    run: str
    broken: str
    harm: str
    file: str
    outcome: str
    words: str = ""


def write_inputs(folder: Path) -> None:
    """Write a movie of two cells with a signal, an image of ten cells, and a batch of both."""
    rng = np.random.default_rng(0)
    cell = np.pad(cd.simulate.random_smooth(3, radius=9), 3).astype(np.uint8)
    frames = np.stack([np.hstack([np.roll(cell, k, 1), 2 * np.roll(cell, -k, 0)]) for k in range(5)])
    cells = np.hstack([number * cell for number in range(1, 11)])
    tifffile.imwrite(folder / "movie.tif", frames, metadata={"axes": "TYX"}, photometric="minisblack")
    counts = rng.poisson(80, frames.shape).astype(np.uint16)
    tifffile.imwrite(folder / "signal.tif", counts, metadata={"axes": "TYX"}, photometric="minisblack")
    tifffile.imwrite(folder / "cells.tif", cells, metadata={"axes": "YX"}, photometric="minisblack")
    (folder / "batch.toml").write_text(_BATCH, encoding="utf-8")


def run(name: str, inputs: Path, out: Path, **options: Any) -> None:
    """Do a run into a folder."""
    if name == "map":
        cd.run_map(inputs / "cells.tif", out, geojson=True, **_SMALL, **options)
    elif name == "movie":
        cd.run_movie(inputs / "movie.tif", out, signal=inputs / "signal.tif", **_SMALL, **options)
    elif name == "shapes":
        cd.run_shapes(inputs / "cells.tif", out, csv=True, **options)
    elif name == "compare":
        methods = ("newton", "edge")
        cd.run_compare_windows(inputs / "movie.tif", out, movie=True, methods=methods, **_SMALL, **options)
    else:
        summary = cd.run_batch(inputs / "batch.toml", out, tell=lambda words: None, **options)
        if summary.failed:  # of an input: the others are done
            raise StudyError(f"{summary.failed[0].input}: {summary.failed[0].reason}")


def contents(out: Path) -> dict[str, Any]:
    """What a study's files hold, but for its times: names and bytes, or tables where these have times."""
    found: dict[str, Any] = {}
    for file in sorted(path for path in out.rglob("*") if path.is_file()):
        name = file.relative_to(out).as_posix()
        if file.name in ("provenance.json", ".cytodisk.run") or name.startswith("rows/"):
            found[name] = ""
        elif file.name in ("cells.parquet", "cells.csv"):
            read = pd.read_parquet if file.suffix == ".parquet" else pd.read_csv
            found[name] = read(file).drop(columns="seconds", errors="ignore").to_csv()
        elif file.name in ("inputs.parquet", "inputs.csv"):
            read = pd.read_parquet if file.suffix == ".parquet" else pd.read_csv
            found[name] = read(file)[["input", "status", "mapped", "frames"]].to_csv()
        elif file.name.startswith(("comparison", "by_")):
            found[name] = ""  # summaries of times, too
        else:
            found[name] = file.read_bytes()
    return found


def in_process(work: Callable[..., Any], *arguments: Any) -> tuple[str, str]:
    """Do something in a process of its own: "ok", "refused", "failed" or "killed", and its words."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_answer, args=(theirs, work, *arguments))
    process.start()
    theirs.close()
    try:
        answer = ours.recv() if ours.poll(_TIME_S) else (FAILED, f"took longer than {_TIME_S:g} s")
    except EOFError:
        answer = ("killed", "")
    process.join(1.0)
    if process.is_alive():
        process.kill()
        process.join()
    return answer


def _answer(pipe: Any, work: Callable[..., Any], *arguments: Any) -> None:
    warnings.simplefilter("ignore")
    try:
        work(*arguments)
        pipe.send(("ok", ""))
    except CytodiskError as error:
        pipe.send((REFUSED, str(error)))
    except BaseException as error:  # noqa: BLE001  whatever it is must not have happened
        pipe.send((FAILED, f"{type(error).__name__}: {error}"))
    finally:
        os._exit(0)


def _broken_run(name: str, inputs: Path, out: Path, how: str, point: int) -> None:
    """Do a run that ends at the given point; points are counted in what it does to files."""
    passed = 0

    def at_a_point(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal passed
        if event not in _POINTS or not str(arguments[0]).startswith(str(out)):
            return
        passed += 1
        if passed == point and how == "killed":
            os.kill(os.getpid(), signal.SIGKILL)
        if passed >= point and how == "full disk" and event in ("open", "os.mkdir"):
            if event == "open" and not (arguments[2] or 0) & (os.O_WRONLY | os.O_RDWR):
                return
            raise OSError(errno.ENOSPC, "No space left on device")

    sys.addaudithook(at_a_point)
    run(name, inputs, out)


def _harm(out: Path, how: str, rng: np.random.Generator) -> str:
    """Do harm to a file of a study; its name."""
    if how == "extra part":
        file = out / ".parts" / "00777.json"
        file.parent.mkdir(exist_ok=True)
        file.write_text('{"cell": 777}')
        return file.relative_to(out).as_posix()
    files = sorted(file for file in out.rglob("*") if file.is_file())
    if not files or how == "none":
        return ""
    file = files[int(rng.integers(len(files)))]
    content = file.read_bytes()
    if how == "removed":
        file.unlink()
    elif how == "emptied" or not content:
        file.write_bytes(b"")
    elif how == "cut":
        file.write_bytes(content[: int(rng.integers(len(content)))])
    else:
        place = int(rng.integers(len(content)))
        flipped = bytes([content[place] ^ int(rng.integers(1, 256))])
        file.write_bytes(content[:place] + flipped + content[place + 1 :])
    return file.relative_to(out).as_posix()


class Benchmark:
    """Undisturbed studies, and cases that are compared with them.

    Parameters
    ----------
    folder : Path
        For all files; empty.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        (folder / "inputs").mkdir()
        write_inputs(folder / "inputs")
        self._whole: dict[str, dict[str, Any]] = {}
        self._points: dict[str, int] = {}

    def try_case(self, seed: int) -> Case:
        """Break a study as its seed says, resume it, and compare."""
        rng = np.random.default_rng(seed)
        name, broken, harm = (str(rng.choice(words)) for words in (RUNS, BREAKS, HARMS))
        self._make_whole(name)
        inputs, out = self.folder / f"in_{seed}", self.folder / f"out_{seed}"
        shutil.copytree(self.folder / "inputs", inputs)
        point = int(rng.integers(1, self._points[name] + 1)) if broken != "complete" else sys.maxsize
        try:
            first = in_process(_broken_run, name, inputs, out, broken, point)
            if first[0] == FAILED:
                return Case(seed, name, broken, harm, "", FAILED, f"first: {first[1]}")
            file = ""
            if harm == "changed input":
                file = "batch.toml" if name == "batch" else "cells.tif"
                for changed in ("cells.tif", "movie.tif"):
                    frames = tifffile.imread(inputs / changed)
                    axes = "TYX" if frames.ndim == 3 else "YX"
                    frames = np.roll(frames, 1, -1)
                    options = {"metadata": {"axes": axes}, "photometric": "minisblack"}
                    tifffile.imwrite(inputs / changed, frames, **options)
            elif out.exists():
                studies = sorted(out.glob("inputs/*/"))
                place = studies[0] if name == "batch" and harm == "extra part" and studies else out
                file = _harm(place, harm, rng)
            how, words = in_process(lambda: run(name, inputs, out, resume=True))
            if how == "ok" and harm != "changed input":
                how, words = self._compared(name, out)
            elif how == "ok":
                how, words = self._of_changed_input(name, out, inputs)
            return Case(seed, name, broken, harm, file, how, words.replace(str(self.folder), ""))
        finally:
            shutil.rmtree(inputs)
            shutil.rmtree(out, ignore_errors=True)

    def _make_whole(self, name: str) -> None:
        """Do an undisturbed run, and count the points at which it could be broken."""
        if name in self._whole:
            return
        out, counts = self.folder / f"whole_{name}", self.folder / f"points_{name}"

        def counted() -> None:
            points = 0

            def count(event: str, arguments: tuple[Any, ...]) -> None:
                nonlocal points
                points += event in _POINTS and str(arguments[0]).startswith(str(out))

            sys.addaudithook(count)
            run(name, self.folder / "inputs", out)
            counts.write_text(str(points))

        outcome = in_process(counted)
        assert outcome[0] == "ok", outcome
        self._points[name], self._whole[name] = int(counts.read_text()), contents(out)

    def _compared(self, name: str, out: Path) -> tuple[str, str]:
        return _difference(self._whole[name], contents(out))

    def _of_changed_input(self, name: str, out: Path, inputs: Path) -> tuple[str, str]:
        """Whether a run that was not refused has done all of the input as it is now."""
        anew = out.with_name(f"{out.name}_anew")
        try:
            how, words = in_process(lambda: run(name, inputs, anew))
            return (how, words) if how != "ok" else _difference(contents(anew), contents(out))
        finally:
            shutil.rmtree(anew, ignore_errors=True)


def _difference(whole: dict[str, Any], found: dict[str, Any]) -> tuple[str, str]:
    names = sorted(name for name in {*whole, *found} if whole.get(name) != found.get(name))
    return (DIFFERENT, ", ".join(names)) if names else (SAME, "")


def main() -> int:
    """Try cases, print a table and what went wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--results", type=Path)
    given = parser.parse_args()
    cases: dict[int, Case] = {}
    if given.results is not None and given.results.exists():
        lines = given.results.read_text(encoding="utf-8").splitlines()
        cases = {case.seed: case for case in (Case(**json.loads(line)) for line in lines)}
    started = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="broken-") as folder:
        benchmark = Benchmark(Path(folder))
        for seed in range(given.first, given.first + given.count):
            if seed in cases:
                continue
            cases[seed] = benchmark.try_case(seed)
            if given.results is not None:
                with given.results.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(cases[seed])) + "\n")
    say(list(cases.values()), time.perf_counter() - started)
    return int(any(case.outcome in (DIFFERENT, FAILED) for case in cases.values()))


def say(cases: list[Case], seconds: float) -> None:
    """Print how many cases of each kind came to what."""
    outcomes = (SAME, REFUSED, DIFFERENT, FAILED)
    print(f"{'broken':<10} {'then':<14} " + " ".join(f"{outcome:>9}" for outcome in outcomes))
    for broken in BREAKS:
        for harm in HARMS:
            counts = Counter(case.outcome for case in cases if (case.broken, case.harm) == (broken, harm))
            if counts:
                print(f"{broken:<10} {harm:<14} " + " ".join(f"{counts[one]:>9}" for one in outcomes))
    counts = Counter(case.outcome for case in cases)
    print(f"{'all':<10} {'':<14} " + " ".join(f"{counts[one]:>9}" for one in outcomes))
    print(f"{len(cases)} cases in {seconds:.0f} s")
    for case in cases:
        if case.outcome in (DIFFERENT, FAILED):
            print(f"seed {case.seed}: {case.run}, {case.broken}, {case.harm} {case.file}: {case.words}")
    for words, count in Counter(_kind(case.words) for case in cases if case.outcome == REFUSED).items():
        print(f"refused {count}: {words}")


def _kind(words: str) -> str:
    """The words of a refusal without the names in them."""
    return " ".join(word for word in words.split() if not any(mark in word for mark in "/.0123456789"))[:150]


if __name__ == "__main__":
    sys.exit(main())
