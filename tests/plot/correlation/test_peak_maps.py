from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError, WindowError
from cytodisk.plot.correlation.peak_maps import (
    CLUSTER_NAME,
    OUTLINE_NAME,
    PALE_NAME,
    PeakMap,
    Shown,
    draw_peaks_on_cell,
    draw_peaks_on_disk,
    peak_key,
)
from cytodisk.plot.outline_sides import outline_sides
from cytodisk.plot.style import colour_bar
from cytodisk.windows.polar_windows import CellWindows, polar_windows

GRID = polar_windows(3, 8)
Draw = Callable[..., PolyCollection]


def table(**columns: FloatArray) -> pd.DataFrame:
    """Correlation -0.5 to 0.42, lag -3 to 3 of 5 s; sectors 0 to 3 of layer 0 are significant."""
    layer, sector = np.divmod(np.arange(24), 8)
    values: dict[str, Any] = {
        "cell": 3,
        "layer": layer,
        "sector": sector,
        "correlation": -0.5 + 0.04 * np.arange(24),
        "lag": np.arange(24) % 7 - 3.0,
        "lag_s": 5.0 * (np.arange(24) % 7 - 3.0),
        "q": np.where(np.arange(24) < 4, 0.01, 0.05),
    }
    return pd.DataFrame(values | columns).sample(frac=1.0, random_state=0)


@pytest.fixture(params=["disk", "cell"])
def draw(request: pytest.FixtureRequest, windows: CellWindows) -> Draw:
    def on_disk(ax: Axes, peaks: PeakMap, shown: Shown = "correlation", **options: Any) -> PolyCollection:
        return draw_peaks_on_disk(ax, peaks, GRID, shown, **options)

    def on_cell(ax: Axes, peaks: PeakMap, shown: Shown = "correlation", **options: Any) -> PolyCollection:
        return draw_peaks_on_cell(ax, peaks, windows, shown, **options)

    return on_disk if request.param == "disk" else on_cell


def patch(ax: Axes, name: str) -> list[PathPatch]:
    return [one for one in ax.patches if isinstance(one, PathPatch) and one.get_gid() == name]


def test_windows_have_the_colours_of_their_peaks(ax: Axes, draw: Draw) -> None:
    peaks = PeakMap.of(table(), GRID, cell=3)
    drawn = draw(ax, peaks)
    np.testing.assert_allclose(drawn.get_array(), -0.5 + 0.04 * np.arange(24))
    assert drawn.get_clim() == (-0.5, 0.5)
    lags = draw(ax, peaks, "lag")
    np.testing.assert_allclose(lags.get_array(), 5.0 * (np.arange(24) % 7 - 3.0))
    assert lags.get_clim() == (-15.0, 15.0)
    assert lags.get_cmap().name != drawn.get_cmap().name
    assert draw(ax, peaks, limit=1.0).get_clim() == (-1.0, 1.0)


def test_clusters_have_a_bold_outline_and_their_number(ax: Axes, draw: Draw) -> None:
    number = np.where(np.arange(24) % 8 >= 6, 1, np.where(np.arange(24) == 3, 2, 0))
    number[[0, 8]] = 1  # over the last sector
    peaks = PeakMap.of(table(cluster=number), GRID, cell=3)
    draw(ax, peaks)
    outlined = patch(ax, CLUSTER_NAME)
    assert len(outlined) == 2
    assert all(len(one.get_path().to_polygons()) == 1 for one in outlined)
    texts = [text for text in ax.texts if text.get_gid() == CLUSTER_NAME]
    assert [text.get_text() for text in texts] == ["1", "2"]
    for line, text in zip(outlined, texts, strict=True):
        assert line.get_path().contains_point(text.get_position())
    assert any("cluster" in str(handle.get_label()) for handle in peak_key(peaks))
    plain = PeakMap.of(table(), GRID, cell=3)
    assert not any("cluster" in str(handle.get_label()) for handle in peak_key(plain))


def test_a_cluster_that_does_not_survive_has_a_thin_broken_outline(ax: Axes, draw: Draw) -> None:
    number = np.where(np.arange(24) == 3, 2, np.where(np.arange(24) == 6, 1, 0))
    peaks = PeakMap.of(table(cluster=number), GRID, cell=3, lost=[2])
    draw(ax, peaks)
    kept, lost = patch(ax, CLUSTER_NAME)
    assert lost.get_linewidth() < kept.get_linewidth()
    assert kept.get_linestyle() in ("-", "solid")
    assert lost.get_linestyle() not in ("-", "solid")
    labels = [str(handle.get_label()) for handle in peak_key(peaks, partial="without geometry")]
    assert labels[-2:] == ["cluster, p ≤ 0.05", "cluster, not without geometry"]


def test_windows_that_are_not_significant_are_pale_and_hatched(ax: Axes, draw: Draw) -> None:
    peaks = PeakMap.of(table(), GRID, cell=3)
    drawn = draw(ax, peaks)
    opacity = np.asarray(drawn.get_alpha())
    np.testing.assert_array_equal(np.flatnonzero(opacity == 1.0), np.arange(4))
    (hatched,), (framed,) = patch(ax, PALE_NAME), patch(ax, OUTLINE_NAME)
    assert hatched.get_hatch()
    ends = [
        np.concatenate([path.vertices for path in drawn.get_paths()[k]]) for k in (slice(4), slice(4, 24))
    ]
    for region, vertices in zip((framed, hatched), ends, strict=True):
        box = region.get_path().get_extents()
        np.testing.assert_allclose(box.min, vertices.min(axis=0), atol=1e-9)
        np.testing.assert_allclose(box.max, vertices.max(axis=0), atol=1e-9)
    labels = [handle.get_label() for handle in peak_key(peaks)]
    assert labels == ["not significant (q ≥ 0.05): 20 of 24", "q < 0.05"]


def test_a_frame_goes_around_neighbours_once(ax: Axes) -> None:
    """Half of the ring of layer 0: two arcs and two radii, no line between its sectors."""
    draw_peaks_on_disk(ax, PeakMap.of(table(), GRID, cell=3), GRID)
    (framed,) = patch(ax, OUTLINE_NAME)
    (ring,) = framed.get_path().to_polygons(closed_only=False)
    radius = np.hypot(*ring.T)
    inner = GRID.radii[1]
    assert (np.isclose(radius, 1.0) | np.isclose(radius, inner)).all()
    straight = np.hypot(*np.diff(ring, axis=0).T)
    np.testing.assert_allclose(np.sort(straight)[-2:], 1.0 - inner)
    assert straight.size > 40
    assert np.sort(straight)[-3] < 0.05


def test_without_a_test_nothing_is_pale(ax: Axes, draw: Draw) -> None:
    for rows in (table().drop(columns="q"), table(q=np.full(24, np.nan))):
        peaks = PeakMap.of(rows, GRID, cell=3)
        assert draw(ax, peaks).get_alpha() is None
        assert not patch(ax, PALE_NAME)
        assert not peak_key(peaks)


def test_windows_without_a_correlation_are_grey(ax: Axes, draw: Draw) -> None:
    gap = np.where(np.arange(24) == 5, np.nan, 0.3)
    rows = table(
        correlation=gap, lag_s=np.where(np.isnan(gap), np.nan, 5.0), q=np.where(np.isnan(gap), np.nan, 0.5)
    )
    peaks = PeakMap.of(rows[rows["sector"] != 7], GRID, cell=3)
    drawn = draw(ax, peaks)
    missing = np.ma.getmaskarray(drawn.get_array())
    np.testing.assert_array_equal(np.flatnonzero(missing), [5, 7, 15, 23])
    assert [handle.get_label() for handle in peak_key(peaks)] == [
        "not significant (q ≥ 0.05): 20 of 20",
        "none, or not used",
    ]


def test_colour_bars_are_not_pale() -> None:
    figure = Figure()
    ax, into = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2)
    drawn = draw_peaks_on_disk(ax, PeakMap.of(table(), GRID, cell=3), GRID)
    assert colour_bar(drawn, into, "peak correlation").alpha is None


def test_limits() -> None:
    one = PeakMap.of(table(correlation=np.linspace(-0.995, 0.2, 24)), GRID, cell=3)
    assert one.limit("correlation") == 1.0
    nothing = np.full(24, np.nan)
    empty = PeakMap.of(table(correlation=nothing, lag_s=nothing, lag=nothing), GRID, cell=3)
    assert (empty.limit("correlation"), empty.limit("lag")) == (1.0, 1.0)
    assert PeakMap.of(
        table(correlation=np.zeros(24), lag=np.zeros(24), lag_s=np.zeros(24)), GRID, cell=3
    ).limit("lag") == pytest.approx(1.0)


@pytest.mark.parametrize(("layers", "sectors"), [(1, 1), (2, 1), (1, 3)])
def test_coarse_grids(ax: Axes, windows: CellWindows, layers: int, sectors: int) -> None:
    grid = polar_windows(layers, sectors)
    layer, sector = np.divmod(np.arange(grid.n_windows), sectors)
    rows = pd.DataFrame({"cell": 0, "layer": layer, "sector": sector, "correlation": 0.5, "lag": 1, "q": 0.5})
    rows.loc[0, "q"] = 0.01
    peaks = PeakMap.of(rows, grid)
    assert len(draw_peaks_on_disk(ax, peaks, grid).get_paths()) == grid.n_windows
    on_cell = draw_peaks_on_cell(ax, peaks, grid.on(windows.disk))
    assert len(on_cell.get_paths()) == grid.n_windows
    assert peaks.lag_unit.unit == "frames"


def test_what_does_not_fit_is_refused(ax: Axes) -> None:
    with pytest.raises(ParameterError, match="layer 2 and sector 7, the grid 2 layers"):
        PeakMap.of(table(), polar_windows(2, 8), cell=3)
    with pytest.raises(ParameterError, match="windows has no cell 0"):
        PeakMap.of(table(), GRID)
    with pytest.raises(ParameterError, match=r"alpha.*5"):
        PeakMap.of(table(), GRID, cell=3, alpha=5)
    peaks = PeakMap.of(table(), GRID, cell=3)
    with pytest.raises(ParameterError, match="shown must be one of correlation, lag"):
        draw_peaks_on_disk(ax, peaks, GRID, "p")  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"limit.*-1"):
        draw_peaks_on_disk(ax, peaks, GRID, limit=-1.0)
    with pytest.raises(WindowError, match="values has shape"):
        draw_peaks_on_disk(ax, peaks, polar_windows(4, 8))


def test_outlines_follow_the_sides_of_pixels() -> None:
    region = np.array([[False, True, True], [False, False, False]])
    sides = {tuple(sorted(map(tuple, side))) for side in outline_sides(region).tolist()}
    expected = [((1, 0), (2, 0)), ((2, 0), (3, 0)), ((1, 1), (2, 1)), ((2, 1), (3, 1))]
    assert sides == {*expected, ((1, 0), (1, 1)), ((3, 0), (3, 1))}
    assert outline_sides(np.zeros((2, 2), dtype=bool)).shape == (0, 2, 2)
