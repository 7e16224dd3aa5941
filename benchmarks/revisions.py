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


def package_of(revision: str, folder: Path) -> Path:
    """Folder that holds the package as it was at a revision; "." stands for the files as they are."""
    if revision == ".":
        return _ROOT / "src"
    archive = subprocess.run(
        ["git", "-C", str(_ROOT), "archive", revision, "src"], capture_output=True, check=False
    )
    if archive.returncode:
        raise SystemExit(f"{revision}: {archive.stderr.decode().strip()}")
    with tarfile.open(fileobj=BytesIO(archive.stdout)) as files:
        files.extractall(folder, filter="data")
    return folder / "src"


def compare(revisions: Sequence[str], names: Sequence[str], data: Path, rounds: int) -> list[list[str]]:
    """Rows of a table: what, before, after, ratio and its range over rounds; the first is the head."""
    with tempfile.TemporaryDirectory() as name:
        sources = [package_of(one, Path(name) / str(number)) for number, one in enumerate(revisions)]
        # The first run of a copy compiles its kernels, and does not count.
        for source in sources:
            measure("map_time", data, source)
        found = with_progress(names, lambda block: _in_turns(block, data, sources, rounds))
    rows = [["what", *revisions, "ratio", "from – to"]]
    for block, (values, missing) in found.items():
        rows += [[what, *change_in_words(*pair)] for what, pair in values.items()]
        rows += [
            [f"block {block}", *(why or "measured" for why in missing), "", ""] for _ in range(any(missing))
        ]
    return rows


def _in_turns(
    block: str, data: Path, sources: Sequence[Path], rounds: int
) -> tuple[dict[str, tuple[list[Figure], list[Figure]]], list[str]]:
    """Figures of both revisions by name, of each round; and why one has none."""
    values: dict[str, tuple[list[Figure], list[Figure]]] = {}
    missing = [""] * len(sources)
    for _ in range(rounds):
        for side, source in enumerate(sources):
            if missing[side]:
                continue
            figures, why = measure(block, data, source)
            missing[side] = why and f"missing: {why}"
            for figure in figures:
                values.setdefault(figure.what, ([], []))[side].append(figure)
    return values, missing


def change_in_words(before: Sequence[Figure], after: Sequence[Figure]) -> list[str]:
    """Medians of both sides, their ratio and its range."""
    unit = (*before, *after)[0].unit
    sides = [np.array([figure.value for figure in side]) for side in (before, after)]
    shown = [f"{np.median(side):.4g} {unit}".strip() if side.size else "missing" for side in sides]
    if not all(side.size for side in sides) or not (sides[0] != 0).all():
        return [*shown, "", ""]
    rounds = min(side.size for side in sides)
    ratios = sides[1][:rounds] / sides[0][:rounds]
    ratio = np.median(sides[1]) / np.median(sides[0])
    return [*shown, f"{ratio:.3f}", f"{ratios.min():.3f} – {ratios.max():.3f}"]
