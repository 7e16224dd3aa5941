"""Damage thousands of files and see that each is read or refused in words.

    benchmarks/fuzz.py [--mutants N] [--seed S] [--first K] [--workers W] [--kinds A,B] [--keep FOLDER]

A mutant is a good file of one kind (see `fuzz_targets.py`), damaged in its bytes or in its structure. It is
used as commands use such a file. It must be read, or end in a `CytodiskError` that names a file; anything
else is a failure: another exception, a process that dies, more than 20 s of a processor or 60 s by the clock,
or more than 2 GB of memory above what the process had. Mutant number k of a seed is always the same, so a
run that was stopped goes on with `--first`, and `--first k --mutants 1` repeats one. Failed mutants are kept
in `--keep`, with what went wrong.
Prints counts by kind; ends with status 1 if any mutant failed.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any

MUTANTS, SECONDS, MOST_BYTES = 5000, 20.0, 2 * 10**9
_MOST_BY_CLOCK_S = 60.0
GOOD = ("read", "refused")
_READY_S = 120.0
_STATUS = Path("/proc/self/status")


@dataclass(frozen=True)
class Outcome:
    """What became of a mutant.

    Attributes
    ----------
    number : int
    kind : str
    result : {"read", "refused", "unnamed", "traceback", "crash", "slow", "memory"}
    words : str
        The message, or what went wrong.
    file : str
        The damaged file.
    seconds : float
    """

    number: int
    kind: str
    result: str
    words: str
    file: str = ""
    seconds: float = 0.0


def damage(files: Path, place: Path, number: int, seed: int, kinds: Sequence[str]) -> tuple[Any, Path, Path]:
    """Make a mutant.

    Returns
    -------
    target : Target
    path : Path
        What is to be used: a file or a folder.
    damaged : Path
    """
    from fuzz_files import copied
    from fuzz_targets import target_of

    target, random = target_of(number, seed, kinds)
    path = copied(files, target.root, place)
    among = sorted(file for file in path.glob(target.pattern) if file.is_file()) if target.pattern else [path]
    damaged = among[int(random.integers(len(among)))]
    mutation = target.mutations[int(random.integers(len(target.mutations)))]
    content = mutation(random, damaged.read_bytes())
    damaged.unlink()
    damaged.write_bytes(content)
    return target, damaged if target.alone else path, damaged


def try_mutant(files: Path, number: int, seed: int, kinds: Sequence[str] = ()) -> Outcome:
    """Make a mutant in a folder of its own, use it, and see what comes of it."""
    from cytodisk.errors import CytodiskError

    with tempfile.TemporaryDirectory(prefix="fuzz-", ignore_cleanup_errors=True) as place:
        target, path, damaged = damage(files, Path(place), number, seed, kinds)
        name, started = str(damaged.relative_to(place)), time.process_time()
        base = _memory("VmRSS")
        _forget_peak()
        result, words = "read", ""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                target.use(path, damaged, number)
        except CytodiskError as error:
            words = str(error)
            result = "refused" if _names(words, path, damaged) else "unnamed"
        except MemoryError:
            result, words = "memory", traceback.format_exc()
        except Exception:  # noqa: BLE001  that is what is looked for
            result, words = "traceback", traceback.format_exc()
        seconds = time.process_time() - started
        used = _memory("VmHWM") - base
    if used > MOST_BYTES:
        result, words = "memory", f"{used / 1e9:.1f} GB; {words}"
    return Outcome(number, target.kind, result, words, name, round(seconds, 2))


def _names(words: str, path: Path, damaged: Path) -> bool:
    """Whether a message says which file it means, on one line or as a list of faults."""
    return any(name in words for name in (path.name, damaged.name, damaged.parent.name))


def _memory(what: str) -> int:
    for line in (
        _STATUS.read_text(encoding="ascii", errors="replace").splitlines() if _STATUS.exists() else ()
    ):
        if line.startswith(f"{what}:"):
            return int(line.split()[1]) * 1024
    return 0


def _forget_peak() -> None:
    if _STATUS.exists():
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


def work(files: Path, seed: int, kinds: Sequence[str]) -> None:
    """The far end of a worker: try the mutants whose numbers come by stdin, and answer in JSON."""
    import fuzz_targets  # noqa: F401  a second or two

    _limit_memory()
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    print("ready", file=answers, flush=True)
    for line in sys.stdin:
        print(json.dumps(vars(try_mutant(files, int(line), seed, kinds))), file=answers, flush=True)


def _limit_memory() -> None:
    import resource

    most = _memory("VmSize") + MOST_BYTES + MOST_BYTES // 2  # what is measured is the memory that is used
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Worker:
    """The near end of a process that tries mutants; it is replaced when it dies."""

    def __init__(self, files: Path, seed: int, kinds: Sequence[str]):
        self._command = [sys.executable, __file__, "--files", str(files), "--seed", str(seed)]
        self._command += ["--kinds", ",".join(kinds), "--work"]
        self._process: subprocess.Popen[str] | None = None
        self._errors: Any = None

    def outcome(self, number: int) -> Outcome:
        """What becomes of a mutant."""
        process = self._ready()
        assert process.stdin is not None
        print(number, file=process.stdin, flush=True)
        line = self._line(_MOST_BY_CLOCK_S)
        if line:
            found = Outcome(**json.loads(line))
            return found if found.seconds <= SECONDS or found.result not in GOOD else _slow(found)
        code = None
        with suppress(subprocess.TimeoutExpired):  # the pipe ends a moment before the process
            code = process.wait(1.0)
        self.close()
        if code is None:
            return Outcome(number, self._kind_of(number), "slow", f"more than {_MOST_BY_CLOCK_S:g} s")
        return Outcome(number, self._kind_of(number), "crash", f"exit code {code}\n{self._log()}")

    def close(self) -> None:
        """End the process."""
        if self._process is None:
            return
        self._process.kill()
        self._process.wait()
        self._reader.join()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(BrokenPipeError):
                if pipe is not None:
                    pipe.close()
        self._process = None

    def forget(self) -> None:
        """Close what the last process said."""
        if self._errors is not None:
            self._errors.close()

    def _ready(self) -> "subprocess.Popen[str]":
        if self._process is not None and self._process.poll() is not None:
            self.close()
        if self._process is None:
            self.forget()
            self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115  as long as the process
            environment = os.environ | dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
            self._process = subprocess.Popen(
                [self._command[0], "-X", "faulthandler", *self._command[1:]],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                text=True,
                env=environment,
            )
            self._lines: SimpleQueue[str] = SimpleQueue()
            self._reader = Thread(target=_pass_on, args=(self._process.stdout, self._lines), daemon=True)
            self._reader.start()
            if self._line(_READY_S).strip() != "ready":
                raise RuntimeError(f"a worker does not start:\n{self._log()}")
        return self._process

    def _line(self, within_s: float) -> str:
        try:
            return self._lines.get(timeout=within_s)
        except Empty:
            return ""

    def _log(self) -> str:
        """What the last process said; its file is closed."""
        with self._errors:
            self._errors.seek(0)
            return self._errors.read()[-4000:]

    def _kind_of(self, number: int) -> str:
        from fuzz_targets import target_of

        given = self._command[self._command.index("--kinds") + 1]
        seed = int(self._command[self._command.index("--seed") + 1])
        return target_of(number, seed, [kind for kind in given.split(",") if kind])[0].kind


def _pass_on(lines: Any, queue: "SimpleQueue[str]") -> None:
    for line in lines:
        queue.put(line)
    queue.put("")


def _slow(found: Outcome) -> Outcome:
    return Outcome(
        found.number, found.kind, "slow", f"{found.seconds:g} s; {found.words}", found.file, found.seconds
    )


def outcomes(
    files: Path, numbers: Sequence[int], seed: int, workers: int, kinds: Sequence[str] = ()
) -> Iterator[Outcome]:
    """What becomes of mutants, in no order."""
    waiting: SimpleQueue[int] = SimpleQueue()
    for number in numbers:
        waiting.put(number)
    found: SimpleQueue[Outcome | BaseException] = SimpleQueue()

    def serve() -> None:
        worker = Worker(files, seed, kinds)
        try:
            while True:
                found.put(worker.outcome(waiting.get_nowait()))
        except Empty:
            pass
        except BaseException as error:  # noqa: BLE001  raised where outcomes are taken
            found.put(error)
        finally:
            worker.close()
            worker.forget()

    with ThreadPoolExecutor(workers) as threads:
        for _ in range(workers):
            threads.submit(serve)
        for _ in numbers:
            one = found.get()
            if isinstance(one, BaseException):
                raise one
            yield one


def keep(files: Path, folder: Path, outcome: Outcome, seed: int, kinds: Sequence[str]) -> None:
    """Put a mutant that failed into a folder, with what went wrong."""
    place = folder / f"{seed}_{outcome.number:06d}_{outcome.result}"
    shutil.rmtree(place, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix="fuzz-") as work_folder:
        _, _, damaged = damage(files, Path(work_folder), outcome.number, seed, kinds)
        place.mkdir(parents=True)
        shutil.copy(damaged, place / damaged.name)
    (place / "what.txt").write_text(f"{outcome.kind}: {outcome.file}\n{outcome.words}\n", encoding="utf-8")


def table(counts: dict[str, Counter[str]], seconds: dict[str, float]) -> str:
    """Counts by kind as lines."""
    columns = ("read", "refused", "unnamed", "traceback", "crash", "slow", "memory")
    lines = [f"{'kind':18}" + "".join(f"{name:>10}" for name in columns) + f"{'longest':>10}"]
    total: Counter[str] = sum(counts.values(), Counter())
    for kind, of_kind in [*sorted(counts.items()), ("all", total)]:
        longest = seconds.get(kind, max(seconds.values(), default=0.0))
        lines.append(f"{kind:18}" + "".join(f"{of_kind[name]:10}" for name in columns) + f"{longest:8.1f} s")
    return "\n".join(lines)


def main() -> int:
    given = _arguments()
    kinds = [kind for kind in given.kinds.split(",") if kind]
    if given.work:
        work(given.files, given.seed, kinds)
        return 0
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    longest: dict[str, float] = defaultdict(float)
    failed, started = 0, time.monotonic()
    with tempfile.TemporaryDirectory(prefix="fuzz-files-") as place:
        files = given.files or Path(place) / "files"
        if not files.exists():
            from fuzz_files import make_files

            make_files(files)
        numbers = range(given.first, given.first + given.mutants)
        for outcome in outcomes(files, numbers, given.seed, given.workers, kinds):
            counts[outcome.kind][outcome.result] += 1
            longest[outcome.kind] = max(longest[outcome.kind], outcome.seconds)
            if outcome.result not in GOOD:
                failed += 1
                last = outcome.words.strip().splitlines()[-1:] or [""]
                print(
                    f"{outcome.number} {outcome.kind} {outcome.file} {outcome.result}: {last[0][:200]}",
                    flush=True,
                )
                if given.keep:
                    keep(files, given.keep, outcome, given.seed, kinds)
    print(table(counts, longest))
    minutes = (time.monotonic() - started) / 60
    print(f"{failed} of {given.mutants} mutants failed; {minutes:.1f} min with {given.workers} workers")
    return int(failed > 0)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mutants", type=int, default=MUTANTS)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kinds", default="", help="with commas between; default all")
    parser.add_argument("--keep", type=Path, help="folder for mutants that failed")
    parser.add_argument("--files", type=Path, help="folder of good files; made where it is absent")
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
