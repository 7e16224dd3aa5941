"""Results of one revision of the package, for `same_results.py`: each command on simulated and real cells."""

import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tifffile

from suite import THREADS

# Words of the command line: as they are now, and as they were.
RENAMED_WORDS = {"compare-windows": "compare", "--no-registration": "--no-register"}
_MELANOMA = Path("melanoma_vasp_lpd")
_RAC1 = Path("dictyostelium_rac1")


@dataclass(frozen=True)
class Amount:
    """How much is run: cells of a stack, cells to compare, and frames of a movie (None for all)."""

    cells: int = 60
    compared: int = 4
    frames: int | None = 10


def make_results(source: Path, out: Path, data: Path, amount: Amount) -> None:
    """Run every command with the package in a folder.

    Parameters
    ----------
    source : Path
        Folder that holds the package `cytodisk`.
    out : Path
        Folder for the results, a subfolder a command; must not exist.
    data : Path
        Folder of the real data.
    amount : Amount
    """
    out.mkdir(parents=True)
    _check_package(source)
    write_inputs(data, out / "inputs", amount)
    old = {new: was for new, was in RENAMED_WORDS.items() if new not in _help_of(source)}
    for name, words in commands():
        print(f"{name} …", file=sys.stderr, flush=True)
        words = [old.get(word, word) for word in words]
        run = _cytodisk(source, words, out)
        (out / f"{name}.log").write_text(run.stdout + run.stderr, encoding="utf-8")
        if run.returncode:
            raise SystemExit(f"cytodisk {' '.join(words)} ended with {run.returncode}:\n{run.stderr[-2000:]}")


def commands() -> Iterator[tuple[str, list[str]]]:
    """Name and words of every run, in the folder of the results."""
    mapped = "map inputs/rac1_masks.tif --signal inputs/rac1.tif --kind stack"
    rac1 = "movie inputs/rac1_masks.tif --signal inputs/rac1.tif --pixel-size 0.1 --frame-interval 1.29"
    lines = {
        "demo": "demo -o demo",
        "map": "map inputs/cells.tif -o map --kind stack --geojson",
        "map_signal": f"{mapped} -o map_signal --pixel-size 0.2 --nan omit --spacing radius --layers 6",
        "map_harmonic": f"{mapped} -o map_harmonic --method harmonic --align 30 --sectors 24",
        "map_labels": "map inputs/labels.tif -o map_labels --kind labels --shape-weight 0.02",
        "shapes": "shapes inputs/cells.tif -o shapes --kind stack --pixel-size 0.3",
        "compare": "compare-windows inputs/few.tif -o compare --kind stack --layers 6 --sectors 24",
        "compare_movie": "compare-windows inputs/rac1_masks.tif -o compare_movie --movie "
        "--signal inputs/rac1.tif --layers 6 --sectors 24 --depth-px 4",
        "movie": "movie inputs/masks.tif --signal inputs/signal.ome.tif -o movie "
        "--frame-interval 5 --channels VASP,Lpd",
        "movie_depth": f"{rac1} -o movie_depth --depth-um 0.4 --no-registration --tension 0.5",
        "movie_demons": f"{rac1} -o movie_demons --tracker demons --layers 4 --sectors 24",
        "movie_labels": "movie inputs/labels.tif -o movie_labels --kind labels --link "
        "--sectors 24 --layers 4",
        "correlate": "correlate movie --signal VASP --with velocity",
        "correlate_pair": "correlate movie --signal VASP --with Lpd --pairs --detrend linear",
        "correlate_edge": "correlate movie --signal Lpd --with Lpd --against edge --difference "
        "--null shift --max-lag 8 --rule largest --name edge",
        "batch": "batch inputs/study.toml -o batch",
    }
    for name, line in lines.items():
        yield name, line.split()


def write_inputs(data: Path, folder: Path, amount: Amount) -> None:
    """Write what the commands read: links to whole files, and copies of parts."""
    folder.mkdir()
    for name, path in (("masks", _MELANOMA / "mask.tif"), ("signal.ome", _MELANOMA / "signal.ome.tif")):
        (folder / f"{name}.tif").symlink_to(data.absolute() / path)
    cells = tifffile.imread(data / "osteosarcoma" / "masks.tif")
    for name, number in (("cells", amount.cells), ("few", amount.compared)):
        some = np.linspace(0, len(cells) - 1, min(number, len(cells))).astype(int)
        tifffile.imwrite(folder / f"{name}.tif", cells[some], metadata={"axes": "IYX"})
    for name, path in (("rac1_masks", _RAC1 / "mask.tif"), ("rac1", _RAC1 / "rac1.tif")):
        _cut(data / path, folder / f"{name}.tif", amount.frames and 2 * amount.frames)
    _cut(next((data / "label_movies").glob("*U373*ST*")), folder / "labels.tif", amount.frames)
    for part in ("tracked_cells", "label_movies"):
        (folder / part).mkdir()
        for path in sorted((data / part).glob("*.tif")):
            _cut(path, folder / part / path.name, amount.frames)
    (folder / "study.toml").write_text(
        '[study]\nkind = "movie"\n\n[parameters]\nlayers = 6\nsectors = 24\n\n'
        '[[inputs]]\nmasks = "tracked_cells/*.tif"\ncondition = "tracked"\nframe_interval_s = 10.0\n\n'
        '[[inputs]]\nmasks = "label_movies/*.tif"\ncondition = "labels"\n\n'
        '[[inputs]]\nmasks = "rac1_masks.tif"\nsignal = "rac1.tif"\npixel_size_um = 0.2\n'
    )


def _cut(path: Path, target: Path, frames: int | None) -> None:
    stack = tifffile.imread(path)
    tifffile.imwrite(target, stack[:frames], metadata={"axes": "TYX"}, compression="zlib")


def _help_of(source: Path) -> str:
    return "".join(_cytodisk(source, [*words, "--help"], None).stdout for words in ((), ("movie",)))


def _cytodisk(source: Path, words: Sequence[str], folder: Path | None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "cytodisk", *words]
    return subprocess.run(command, env=_environment(source), cwd=folder, capture_output=True, text=True)


def _check_package(source: Path) -> None:
    command = [sys.executable, "-c", "import cytodisk; print(cytodisk.__file__)"]
    found = subprocess.run(command, env=_environment(source), capture_output=True, text=True).stdout.strip()
    if not found or not Path(found).is_relative_to(source.absolute()):
        raise SystemExit(f"{source} does not hold the package: {found or 'nothing'} would be run")


def _environment(source: Path) -> dict[str, str]:
    words = {"PYTHONPATH": str(source.absolute()), "COLUMNS": "200", "TERM": "dumb"}
    return os.environ | dict.fromkeys(THREADS, "1") | words
