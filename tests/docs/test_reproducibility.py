"""What the benchmark of reproducibility compares is one place; random masks go on where they were."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tifffile

BENCHMARKS = str(Path(__file__).parents[2] / "benchmarks")
DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def load() -> Iterator[Any]:
    sys.path.insert(0, BENCHMARKS)
    try:
        yield __import__
    finally:
        sys.path.remove(BENCHMARKS)


def test_outlines_do_not_cross_themselves_and_their_masks_have_their_area(load: Any) -> None:
    shapely = load("shapely")
    drawn = load("cell_outlines")
    shapes = [*drawn.judges(), *drawn.others()]
    assert len({shape.name for shape in shapes}) == len(shapes)
    for shape in shapes:
        polygon = shapely.Polygon(shape.outline_yx)
        assert polygon.is_valid, shape.name
        assert shape.drawn((0.3, 0.6)).mask.sum() == pytest.approx(polygon.area, rel=0.02), shape.name


def test_changes_take_points_of_the_cell_to_the_same_points_of_its_other_masks(load: Any) -> None:
    drawn, same = load("cell_outlines"), load("same_places")
    shape = drawn.Shape("blob", "lobed", drawn.polar(drawn.blob(25.0, seed=4, amplitude=0.3)))
    drawing = shape.drawn((0.2, 0.7))
    random = np.random.default_rng(0)
    changes = {change.name: change for change in same.changes(shape, drawing.places, drawing.mask, random)}
    assert tuple(changes) == same.CHANGES
    rows, columns = np.nonzero(drawing.mask)
    middle = np.array([[rows.mean(), columns.mean()]])
    for change in changes.values():
        there = np.argwhere(change.mask).mean(axis=0)
        # The cell's middle stays its middle; noise moves it a little.
        assert change.place(middle)[0] == pytest.approx(there, abs=0.2), change.name


def test_the_harmonic_map_of_a_cell_turned_mirrored_or_larger_is_nearly_the_same(load: Any) -> None:
    drawn, same = load("cell_outlines"), load("same_places")
    shape = drawn.Shape("ellipse", "round", drawn.ellipse(24.0, 16.0))
    rows = {row["change"]: row for row in same.measure(shape, "harmonic", 0)}
    assert rows["mirrored"]["same_10x60"] > 0.98
    for change in ("turned", "larger"):
        assert rows[change]["shift_px"] < 0.4, change
    assert rows["noise"]["same_20x120"] < rows["noise"]["same_10x60"] < rows["noise"]["same_5x30"]


def test_a_missed_target_of_the_default_method_alone_counts(
    load: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    benchmark = load("reproducibility")
    good = {"window_error_10x60": 0.01, "same_10x60": 0.99}
    rows = [
        {"shape": "star", "method": method, "change": change, **good}
        for method in (benchmark.DEFAULT, "harmonic")
        for change in ("mirrored", "noise")
    ]
    assert benchmark.print_judged(pd.DataFrame(rows))
    rows[2]["same_10x60"] = 0.2
    assert benchmark.print_judged(pd.DataFrame(rows))
    assert "(missed)" in capsys.readouterr().out
    rows[0]["same_10x60"] = 0.2
    assert not benchmark.print_judged(pd.DataFrame(rows))
    assert "  MISSED" in capsys.readouterr().out


def test_a_stopped_run_of_random_masks_goes_on_and_another_version_is_refused(
    load: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    benchmark = load("random_masks")
    results = tmp_path / "results"
    jobs = [("few", seed) for seed in range(3)]
    list(benchmark.run(jobs[:2], results, workers=1))
    first = results.read_text(encoding="utf-8")
    results.write_text(first + '{"kind": "fe', encoding="utf-8")  # stopped in the middle of a line
    trials = list(benchmark.run(jobs, results, workers=1))
    assert [trial.seed for trial in trials] == [0, 1, 2]
    assert not any(trial.failed for trial in trials)
    assert results.read_text(encoding="utf-8").startswith(first)
    monkeypatch.setattr(benchmark, "try_mask", None)  # nothing is left to do
    assert list(benchmark.run(jobs, results, workers=1)) == trials
    other = json.dumps({"version": "another"}) + "\n"
    results.write_text(other, encoding="utf-8")
    with pytest.raises(SystemExit, match="another version"):
        list(benchmark.run(jobs, results, workers=1))


def test_an_empty_window_or_a_wrong_sum_fails_a_mask(load: Any) -> None:
    benchmark = load("random_masks")
    trial = benchmark.try_mask("smooth", 1)
    assert not trial.failed
    for wrong in ({"empty": 1}, {"sum_error": 1e-8}, {"sum_error": np.nan}, {"lost": 1}, {"valid": False}):
        assert benchmark.Trial(**(vars(trial) | wrong)).failed, wrong


def test_each_cell_of_a_label_movie_is_checked_and_large_uneven_ones_fail(load: Any, tmp_path: Path) -> None:
    benchmark = load("real_masks")
    (tmp_path / "label_movies").mkdir()
    labels = np.zeros((2, 30, 40), np.uint8)
    labels[0, 3:20, 4:30], labels[0, 22:28, 2:9], labels[1, 8:25, 8:30] = 3, 7, 3
    tifffile.imwrite(tmp_path / "label_movies" / "a.tif", labels, metadata={"axes": "TYX"})
    jobs = list(benchmark.jobs_of(tmp_path, benchmark.SOURCES, quick=False))
    assert [(job.page, job.label) for job in jobs] == [(0, 3), (0, 7), (1, 3)]
    assert jobs[1].read(tmp_path).sum() == 42
    found = benchmark.check(jobs[1], tmp_path, "harmonic")
    assert (found.job, found.pixels, found.failed) == (jobs[1], 42, False)
    large = vars(found) | {"source": "osteosarcoma", "pixels": benchmark.LARGE_PX}
    assert not benchmark.Check(**(large | {"window_error": 0.15})).failed
    assert benchmark.Check(**(large | {"window_error": 0.16})).failed


def test_the_page_says_the_finest_grid_that_keeps_two_of_three_points(
    load: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(str(DOCS))
    page = load("draw_how_fine")
    shares = {"round": (0.9, 0.8, 0.7), "lobed": (0.8, 0.5, 0.3), "star": (0.6, 0.5, 0.4)}
    rows = pd.DataFrame(
        [
            {"family": name, "shape": name, "method": page.MappingParameters().method, "change": change}
            | dict(zip([f"same_{grid}" for grid in page.GRIDS], share, strict=True))
            | {"shift_px": 1.0, "shift_percent": 2.0}
            for name, share in shares.items()
            for change in ("noise", "mirrored")
        ]
    )
    words = page.words_of(page.by_class(rows))
    assert words.iloc[:, -1].tolist() == ["20 × 120", "5 × 30", "coarser than 5 × 30"]
    written = pd.read_csv(DOCS / "source" / "guides" / "how_fine_a_grid" / "classes.csv")
    assert sorted(written["cells"]) == sorted(words for words, _ in page.CLASSES.values())
    assert written.columns.tolist() == words.columns.tolist()
