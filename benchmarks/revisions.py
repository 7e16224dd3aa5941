"""Two revisions of the package measured in turns by the blocks of `suite.py`."""

import subprocess
import tarfile
import tempfile
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path

import numpy as np

from figure import Figure
from suite import measure, with_progress

_ROOT = Path(__file__).parents[1]
_LESS_IS_BETTER = ("s", "MB")
_WORSE = 1.05


def files_of(revision: str, folder: Path) -> Path:
    """Folder with `src` and `benchmarks` as they were at a revision; "." stands for the files as they are."""
    if revision == ".":
        return _ROOT
    archive = subprocess.run(
        ["git", "-C", str(_ROOT), "archive", revision, "src", "benchmarks"], capture_output=True, check=False
    )
    if archive.returncode:
        raise SystemExit(f"{revision}: {archive.stderr.decode().strip()}")
    with tarfile.open(fileobj=BytesIO(archive.stdout)) as files:
        files.extractall(folder, filter="data")
    return folder


def compare(revisions: Sequence[str], names: Sequence[str], data: Path, rounds: int) -> list[list[str]]:
    """Rows of a table: what, before, after, ratio, its range over rounds, verdict; the first is the head."""
    with tempfile.TemporaryDirectory() as name:
        roots = [files_of(one, Path(name) / str(number)) for number, one in enumerate(revisions)]
        # The first run of a copy compiles its kernels, and does not count.
        for root in roots:
            measure("map_time", data, root)
        found = with_progress(names, lambda block: _in_turns(block, data, roots, rounds))
    rows = [["what", *revisions, "ratio", "from – to", "verdict"]]
    for block, (values, missing) in found.items():
        rows += [[what, *change_in_words(*pair), verdict(*pair)] for what, pair in values.items()]
        if any(missing):
            rows.append([f"block {block}", *(why or "measured" for why in missing), "", "", ""])
    return rows


def _in_turns(
    block: str, data: Path, roots: Sequence[Path], rounds: int
) -> tuple[dict[str, tuple[list[Figure], list[Figure]]], list[str]]:
    """Figures of both revisions by name, of each round; and why one has none."""
    values: dict[str, tuple[list[Figure], list[Figure]]] = {}
    missing = [""] * len(roots)
    for _ in range(rounds):
        for side, root in enumerate(roots):
            if missing[side]:
                continue
            figures, why = measure(block, data, root)
            missing[side] = why and f"missing: {why}"
            for figure in figures:
                values.setdefault(figure.what, ([], []))[side].append(figure)
    return values, missing


def change_in_words(before: Sequence[Figure], after: Sequence[Figure]) -> list[str]:
    """Medians of both sides, their ratio and its range."""
    unit = (*before, *after)[0].unit
    sides = [np.array([figure.value for figure in side]) for side in (before, after)]
    shown = [f"{np.median(side):.4g} {unit}".strip() if side.size else "missing" for side in sides]
    ratios = _ratios(before, after)
    if not ratios.size:
        return [*shown, "", ""]
    ratio = np.median(sides[1]) / np.median(sides[0])
    return [*shown, f"{ratio:.3f}", f"{ratios.min():.3f} – {ratios.max():.3f}"]


def verdict(before: Sequence[Figure], after: Sequence[Figure]) -> str:
    """Whether a time, memory or rate is worse, or better, by more than 5 % in every round."""
    ratios, unit = _ratios(before, after), (*before, *after)[0].unit
    if not ratios.size or not (unit in _LESS_IS_BETTER or unit.endswith("/s")):
        return ""
    if unit.endswith("/s"):
        ratios = 1.0 / ratios
    return "WORSE" if ratios.min() > _WORSE else "better" if ratios.max() < 1.0 / _WORSE else ""


def _ratios(before: Sequence[Figure], after: Sequence[Figure]) -> np.ndarray:
    """After over before, by rounds; empty where a figure is missing or 0."""
    rounds = min(len(before), len(after))
    sides = [np.array([figure.value for figure in side[:rounds]]) for side in (before, after)]
    return sides[1] / sides[0] if (sides[0] != 0).all() and (sides[1] != 0).all() else np.empty(0)
