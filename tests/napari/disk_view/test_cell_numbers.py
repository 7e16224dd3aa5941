"""Numbers of one cell that the dock shows, with a study that is none."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from cytodisk import Scale
from cytodisk.napari.disk_view.cell_numbers import CellNumbers
from cytodisk.napari.disk_view.disk_choices import DiskChoice, disk_choices

PEAK = DiskChoice("correlation", ("Rac1", "velocity"))


def shown_study() -> Any:
    """A study of two cells with two layers of three sectors, and one correlation."""
    lag = {"lag": -2, "lag_s": -10.0}
    rows = [
        {"cell": cell, "layer": layer, "sector": sector, "correlation": 0.1 * (sector - 1), "q": q} | lag
        for cell in (0, 1)
        for layer in (0, 1)
        for sector, q in ((0, 0.2), (2, 0.01))
    ]
    study = SimpleNamespace(
        is_movie=True,
        scale=Scale(0.1, 5.0),
        provenance={"parameters": {"layers": 2, "sectors": 3}},
        correlations=[PEAK.names],
        correlation=lambda signal, with_: SimpleNamespace(windows=pd.DataFrame(rows), settings={}),
    )
    cells = SimpleNamespace(
        mapped={0: [0, 1], 1: [1]},
        missing={1: [(0, "refused: it is in two pieces")]},
        image_shape=(20, 30),
        is_stack=True,
        n_frames=2,
    )
    return SimpleNamespace(study=study, cells=cells, channels=("Rac1",), channel="Rac1", viewer=None)


def test_peaks_of_a_cell_by_window_with_chance_and_lag() -> None:
    numbers = CellNumbers(shown_study(), 1)
    found = numbers.of_windows(PEAK, 0)
    np.testing.assert_allclose(found.values, [[-0.1, np.nan, 0.1]] * 2)
    assert found.limits == (-0.1, 0.1)
    assert found.hatched is not None
    assert found.hatched.tolist() == [[True, False, False]] * 2
    assert numbers.value_words(found, PEAK, 0, (1, 0)) == [
        "peak correlation −0.1 at lag −10 s, not significant"
    ]
    assert numbers.value_words(found, PEAK, 0, (1, 2)) == ["peak correlation 0.1 at lag −10 s"]
    assert numbers.value_words(found, PEAK, 0, (1, 1)) == ["not correlated"]


def test_a_correlation_that_was_made_anew_is_read_again() -> None:
    shown = shown_study()
    numbers, first = CellNumbers(shown, 1), shown.study.correlation(*PEAK.names)
    before = numbers.of_windows(PEAK, 0).values
    changed = first.windows.assign(correlation=0.5)
    shown.study.correlation = lambda *names: SimpleNamespace(windows=changed, settings={"max_lag": 9})

    after = numbers.of_windows(PEAK, 0).values

    assert np.nanmax(before) == 0.1
    assert np.nanmin(after) == np.nanmax(after) == 0.5


def test_lags_of_peaks_are_in_seconds() -> None:
    found = CellNumbers(shown_study(), 1).of_windows(DiskChoice("lag", PEAK.names), 0)
    np.testing.assert_allclose(found.values, [[-10.0, np.nan, -10.0]] * 2)
    assert (found.limits, found.unit) == ((-10.0, 10.0), "s")


@pytest.mark.parametrize(
    ("frame", "words"),
    [(0, ""), (1, "refused: it is in two pieces"), (5, "cell 0 is not in frame 5"), (None, "no frame")],
)
def test_why_there_is_no_map(frame: int | None, words: str) -> None:
    found = CellNumbers(shown_study(), 0).no_map(frame)
    assert found == words if words == "" else words in found


def test_images_that_fit_the_masks_can_be_shown() -> None:
    shown = shown_study()

    class Image(SimpleNamespace):
        """A layer of napari by its name."""

    def layer(name: str, *shape: int, role: str = "") -> Image:
        mark = {"cytodisk": {"role": role}} if role else {}
        return Image(name=name, data=np.zeros(shape), rgb=False, metadata=mark)

    fitting = layer("movie", 2, 20, 30), layer("picture", 20, 30)
    others = layer("short", 1, 20, 30), layer("small", 2, 10, 30), layer("means", 2, 20, 30, role="values")
    shown.viewer = SimpleNamespace(layers=[*fitting, *others])
    labels = [choice.label for choice in disk_choices(shown)]
    assert labels == [
        "mean Rac1",
        "window area",
        "peak correlation, Rac1 with velocity",
        "lag of the peak, Rac1 with velocity",
        "pixels of movie",
        "pixels of picture",
    ]
