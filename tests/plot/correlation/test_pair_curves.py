import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from cytodisk.analysis.pairs.pair_correlation import correlate_pairs
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.pair_curves import OUTLINE_NAME, draw_pairs
from cytodisk.plot.correlation.pair_table import PairTable, drawn_kinds

LAGS = np.arange(-2, 3)
DISTANCES = np.array([0.0, 1.0, 3.0, 5.0, 7.0])  # bins of 2 µm
PAIRS = np.array([16, 80, 96, 60, 4])  # of 16 windows: the last bin holds too few


def pairs(**columns: object) -> pd.DataFrame:
    """Correlation 0.1 distance at lag 0, 0.6 at distance 3 and lag -1, and 0.9 in the bin of few."""
    distance, lag = (table.ravel() for table in np.meshgrid(DISTANCES, LAGS, indexing="ij"))
    mean = np.where(lag == 0, 0.1 * distance, 0.0)
    mean = np.where((distance == 3.0) & (lag == -1), 0.6, mean)
    mean = np.where(distance == 7.0, 0.9, mean)
    table = pd.DataFrame(
        {
            "cell": 0,
            "along": "straight",
            "distance": distance,
            "lag": lag,
            "lag_s": 2.0 * lag,
            "correlation": mean,
            "lower_quartile": mean - 0.1,
            "upper_quartile": mean + 0.2,
            "n": np.repeat(PAIRS, len(LAGS)),
            "threshold": 0.45,
        }
        | columns
    )
    table.attrs["units"] = {"distance": "µm"}
    return table


@pytest.fixture
def axes() -> list[Axes]:
    figure = Figure()
    return [figure.add_subplot(2, 1, 1), figure.add_subplot(2, 1, 2)]


def test_lines_at_lag_0_and_at_the_largest(axes: list[Axes]) -> None:
    lines, _ = draw_pairs(axes, pairs())
    assert [line.get_label() for line in lines] == ["lag 0", "−2 s (largest)"]
    for line, expected in zip(lines, ([0.1, 0.3, 0.5], [0.0, 0.6, 0.0]), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), [1.0, 3.0, 5.0])
        np.testing.assert_allclose(np.asarray(line.get_ydata()), expected)
    bands = [one for one in axes[0].collections if isinstance(one, PolyCollection)]
    box = bands[0].get_paths()[0].get_extents()
    assert (box.y0, box.y1) == pytest.approx((0.0, 0.7))
    (chance,) = (one for one in axes[0].patches if isinstance(one, Rectangle))
    assert chance.get_y() + chance.get_height() == 0.45
    assert axes[1].get_xlabel() == "straight distance (µm)"
    assert axes[1].get_ylabel() == "lag (s)"


def test_the_same_window_stands_apart(axes: list[Axes]) -> None:
    draw_pairs(axes, pairs())
    (dot, other) = (line for line in axes[0].lines if line.get_marker() == "o")
    for one in (dot, other):
        assert np.asarray(one.get_xdata())[0] < 0.0
        assert np.asarray(one.get_ydata())[0] == 0.0
    same, zero, *_ = axes[1].get_xticklabels()
    assert (same.get_text(), zero.get_text()) == ("same\nwindow", "0")
    assert axes[0].get_xlim() == axes[1].get_xlim()
    main, apart = axes[1].images
    assert main.get_extent() == [0.0, 6.0, -5.0, 5.0]
    assert apart.get_extent()[1] < 0.0


def test_the_image_is_by_distance_and_lag(axes: list[Axes]) -> None:
    _, image = draw_pairs(axes, pairs())
    shown = np.asarray(image.get_array())
    assert shown.shape == (5, 3)
    np.testing.assert_allclose(shown[2], [0.1, 0.3, 0.5])
    assert shown[1, 1] == 0.6
    assert image.get_clim() == (-0.6, 0.6)
    outline, _ = (one for one in axes[1].collections if one.get_gid() == OUTLINE_NAME)
    assert isinstance(outline, LineCollection)
    corners = {tuple(point) for side in outline.get_segments() for point in np.round(side, 9).tolist()}
    # The bins around 3 µm at -2 s, and 5 µm at 0 s, touch in one corner.
    around = {(2.0, -3.0), (4.0, -3.0), (2.0, -1.0), (4.0, -1.0), (6.0, -1.0), (4.0, 1.0), (6.0, 1.0)}
    assert corners == around


def test_bins_with_few_pairs_are_left_out() -> None:
    table = PairTable.of(pairs())
    assert table.fewest == 8  # half of 16 windows
    np.testing.assert_array_equal(table.distance, [0.0, 1.0, 3.0, 5.0])
    gap = PairTable.of(pairs(n=np.repeat([16, 80, 4, 156, 0], 5)))
    np.testing.assert_array_equal(gap.distance, [0.0, 1.0, 3.0, 5.0])
    assert np.isnan(gap.correlation[2]).all()
    assert np.isfinite(gap.correlation[[0, 1, 3]]).all()


def test_a_bin_between_gaps_is_a_dot(axes: list[Axes]) -> None:
    for line in draw_pairs(axes, pairs(n=np.repeat([16, 80, 4, 156, 0], 5)))[0]:
        assert line.get_marker() == "."
        assert list(line.get_markevery()) == [True, False, True]


def test_what_was_not_tested_has_neither_band_nor_outline(axes: list[Axes]) -> None:
    draw_pairs(axes, pairs(lag_s=np.nan).drop(columns="threshold"))
    assert not axes[0].patches
    outlines = [one for one in axes[1].collections if one.get_gid() == OUTLINE_NAME]
    assert not any(len(one.get_segments()) for one in outlines if isinstance(one, LineCollection))
    assert axes[1].get_ylabel() == "lag (frames)"
    assert axes[0].get_legend().get_texts()[1].get_text() == "−1 frame (largest)"


def test_the_peak_at_lag_0_is_one_line(axes: list[Axes]) -> None:
    table = pairs()
    lines, _ = draw_pairs(axes, table[table["lag"] >= 0])
    assert [line.get_label() for line in lines] == ["lag 0 (largest)"]


def test_kinds_of_distance(axes: list[Axes]) -> None:
    edge, other = pairs(along="edge"), pairs(along="interior", n=0)
    both = pd.concat([edge, other, pairs(cell=1)])
    assert drawn_kinds(both, 0) == ["edge"]
    assert drawn_kinds(both, 1) == ["straight"]
    draw_pairs(axes, both, along="edge")
    assert axes[1].get_xticklabels()[0].get_text() == "same\nsector"
    with pytest.raises(ParameterError, match=r"along.*'straight'"):
        draw_pairs(axes, both)
    with pytest.raises(ParameterError, match=r"no correlation.*cell 0"):
        draw_pairs(axes, both, along="interior")


def test_pairs_of_the_analysis_can_be_drawn(axes: list[Axes]) -> None:
    rng = np.random.default_rng(2)
    a = xr.DataArray(rng.normal(size=(30, 3, 6)), dims=("time", "layer", "sector"))
    found = correlate_pairs(a, a, 3, bins=5, surrogates=9)
    table = found.to_dataframe().reset_index().assign(cell=0, along="given")
    lines, image = draw_pairs(axes, table, along="given", limit=1.0)
    assert image.get_clim() == (-1.0, 1.0)
    same = [line for line in axes[0].lines if line.get_marker() == "o"]
    np.testing.assert_allclose(np.asarray(same[0].get_ydata(), float), 1.0)  # a window with itself
    held = (
        found["n"].isel(distance=slice(1, None), lag=3).to_numpy()
        >= PairTable.of(table, along="given").fewest
    )
    line = np.asarray(lines[0].get_ydata(), float)
    expected = found["correlation"].sel(lag=0).to_numpy()[1:][: len(line)]
    np.testing.assert_allclose(line[held[: len(line)]], expected[held[: len(line)]])


def test_what_does_not_fit_is_refused(axes: list[Axes]) -> None:
    with pytest.raises(ParameterError, match=r"axes.*1"):
        draw_pairs(axes[:1], pairs())
    with pytest.raises(ParameterError, match=r"limit.*0"):
        draw_pairs(axes, pairs(), limit=0)
    with pytest.raises(ParameterError, match="pairs lacks the columns along, n"):
        draw_pairs(axes, pairs().drop(columns=["along", "n"]))
