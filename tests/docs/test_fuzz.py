"""A hundred and twenty damaged files: each is read, or refused in words that name it."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
MUTANTS, FIRST, SEED = 120, 0, 16
UNDAMAGED = 21  # a number for which uses neither rename files nor write a report


@pytest.fixture(scope="module")
def fuzz() -> Iterator[Any]:
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        yield __import__("fuzz")
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))


@pytest.fixture(scope="module")
def files(fuzz: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place: Path = tmp_path_factory.mktemp("fuzz") / "files"
    __import__("fuzz_files").make_files(place)
    return place


@pytest.mark.slow
def test_no_mutant_ends_in_a_traceback_a_crash_or_hangs(fuzz: Any, files: Path) -> None:
    found = list(fuzz.outcomes(files, range(FIRST, FIRST + MUTANTS), SEED, workers=2))
    assert [one for one in found if one.result not in fuzz.GOOD] == []
    results = {result: sum(one.result == result for one in found) for result in fuzz.GOOD}
    assert results["refused"] > MUTANTS // 4, "damage is not noticed: do mutations still change files?"
    assert results["read"] > MUTANTS // 20, "everything is refused: are the good files read?"


# As masks; they are read as signals.
_NO_MASKS = ("float.tif", "imagej.tif", "movie.ome.tif", "rgb.tif", "zstd.tif")


@pytest.mark.slow
def test_undamaged_each_kind_is_read(files: Path, tmp_path: Path) -> None:
    targets, copied = __import__("fuzz_targets"), __import__("fuzz_files").copied
    read: set[str] = set()
    for number, target in enumerate(targets.TARGETS):
        if target.kind.startswith("batch ") and target.root == "batch":
            continue  # is run again if it is not as it was written
        place = tmp_path / str(number)
        place.mkdir()
        path = copied(files, target.root, place)
        among = (
            sorted(file for file in path.glob(target.pattern) if file.is_file()) if target.pattern else [path]
        )
        is_image = target.root.startswith("images")
        for file in among if is_image else among[:1]:
            for turn in (UNDAMAGED, UNDAMAGED + 1, UNDAMAGED + 2) if is_image else (UNDAMAGED,):
                if not (turn % 3 == 2 and file.name in _NO_MASKS):
                    target.use(file if target.alone else path, file, turn)
                    read.add(target.kind)
    assert {"map", "activity", "GEFF", "TrackMate tracks", "folder of masks", "OME-Zarr 0.5"} <= read
