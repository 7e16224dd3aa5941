from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer, cross_correlate
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.correlation_curves import (
    JITTER_NAME,
    LOST_NAME,
    PARTIAL_NAME,
    PEAK_NAME,
    draw_correlation_curves,
    draw_map_pair,
)
from cytodisk.plot.correlation.curve_key import curve_key
from cytodisk.plot.correlation.lag_axis import sides
from cytodisk.plot.layer_looks import layer_colours
from cytodisk.scale import Scale

LAGS = np.arange(-3, 4)


def curves(layers: int = 6, interval_s: float | None = 5.0, threshold: float = 0.4) -> pd.DataFrame:
    """Mean 0.1 (layer + 1) at lag -2, else 0; quartiles 0.05 apart; of cell 1; cell 0 has others."""
    rows = []
    for cell in (0, 1):
        for layer in range(layers):
            mean = np.where(LAGS == -2, 0.1 * (layer + 1), 0.0) if cell else np.full(7, -0.9)
            rows.append(
                pd.DataFrame(
                    {
                        "cell": cell,
                        "layer": layer,
                        "lag": LAGS,
                        "lag_s": LAGS * (np.nan if interval_s is None else interval_s),
                        "correlation": mean,
                        "lower_quartile": mean - 0.05,
                        "upper_quartile": mean + 0.05,
                        "threshold": threshold,
                    }
                )
            )
    return pd.concat(rows, ignore_index=True)


def peaks(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["lag"] == -2]


def stack(count: int) -> list[Axes]:
    return [Figure().add_subplot() for _ in range(count)]


def dots(ax: Axes) -> list[Line2D]:
    return [line for line in ax.lines if line.get_gid() == PEAK_NAME]


def is_open(dot: Line2D) -> bool:
    return to_rgba(dot.get_markerfacecolor()) == (1.0, 1.0, 1.0, 1.0)


def test_each_layer_has_its_curve_and_its_bands() -> None:
    axes = stack(4)
    lines = draw_correlation_curves(axes, curves(), cell=1, signal="Rac1")
    for ax, line, layer in zip(axes, lines, (0, 2, 3, 5), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), 5.0 * LAGS)
        np.testing.assert_array_equal(line.get_ydata(), np.where(LAGS == -2, 0.1 * (layer + 1), 0.0))
        (band,) = (one for one in ax.collections if isinstance(one, PolyCollection))
        box = band.get_paths()[0].get_extents()
        assert box.y0 == pytest.approx(-0.05)
        assert box.y1 == pytest.approx(0.1 * (layer + 1) + 0.05)
        (chance,) = (one for one in ax.patches if isinstance(one, Rectangle))
        assert (chance.get_y(), chance.get_height()) == (-0.4, 0.8)
        assert any(np.array_equal(one.get_xdata(), [0.0, 0.0]) for one in ax.lines)
        assert ax.get_xlim() == (-15.0, 15.0)
    assert len({ax.get_ylim() for ax in axes}) == 1
    names = [ax.get_title(loc="left") for ax in axes]
    assert names == ["layer 0 (edge)", "layer 2", "layer 3", "layer 5 (centre)"]
    assert axes[-1].get_xlabel() == "lag (s)\n← velocity first  ·  Rac1 first →"
    assert [ax.get_xlabel() for ax in axes[:-1]] == ["", "", ""]


def test_peaks_are_full_by_q_and_not_by_the_band_of_their_layer() -> None:
    axes, table = stack(4), curves()
    found = peaks(table)
    # By themselves layers 3 and 5 of 6 are beyond the band; of all layers only 0 and 5 have a small q.
    q = found["layer"].map({0: 0.01, 1: 0.5, 2: 0.3, 3: 0.05, 4: 0.2, 5: 0.049})
    draw_correlation_curves(axes, table, cell=1, peaks=found.assign(q=q))
    for ax, height, full in zip(axes, (0.1, 0.3, 0.4, 0.6), (True, False, False, True), strict=True):
        (dot,) = dots(ax)
        assert list(np.asarray(dot.get_xdata())) == [-10.0]
        np.testing.assert_allclose(np.asarray(dot.get_ydata()), [height])
        assert is_open(dot) == (not full)
        assert ax.get_title(loc="right") == f"{height:.2f} at −10 s"
    words = [handle.get_label() for handle in curve_key()]
    assert words[2:] == ["chance (95 %, each layer alone)", "peak, q < 0.05 (○ q ≥ 0.05)"]


def test_lags_without_an_interval_are_frames() -> None:
    axes, table = stack(1), curves(1, None)
    (line,) = draw_correlation_curves(axes, table, cell=1, peaks=peaks(table).assign(lag=-1))
    np.testing.assert_array_equal(line.get_xdata(), LAGS)
    assert axes[0].get_xlabel().startswith("lag (frames)\n")
    assert axes[0].get_title(loc="right") == "0.10 at −1 frame"


def test_what_was_not_tested_has_no_band_of_chance() -> None:
    axes, table = stack(2), curves(2).drop(columns="threshold")
    draw_correlation_curves(axes, table, cell=1, peaks=peaks(table))
    assert not any(ax.patches for ax in axes)
    assert not is_open(dots(axes[0])[0])
    assert len(curve_key(chance=False)) == len(curve_key()) - 1


def test_layers_without_a_correlation_and_a_single_lag() -> None:
    axes, table = stack(2), curves(2)
    table.loc[table["layer"] == 0, ["correlation", "lower_quartile", "upper_quartile"]] = np.nan
    first, _ = draw_correlation_curves(axes, table, cell=1, peaks=peaks(table))
    assert np.isnan(np.asarray(first.get_ydata(), dtype=float)).all()
    assert not dots(axes[0])
    assert dots(axes[1])
    (ax,) = stack(1)
    draw_correlation_curves([ax], peaks(curves(1)), cell=1)
    assert ax.get_xlim() == (-10.5, -9.5)


def test_the_words_say_who_is_first() -> None:
    """At a positive lag b follows a: that side belongs to the signal."""
    noise = np.random.default_rng(0).normal(size=62)
    signal = xr.DataArray(noise[2:, None] + np.zeros(4), dims=("time", "sector"))
    velocity = xr.DataArray(noise[:-2, None] + np.zeros(4), dims=("time", "sector"))  # b[t + 2] = a[t]
    peak = peak_correlation(cross_correlate(signal, velocity, 5), rule="largest")
    assert (peak["lag"] == 2).all()
    words = sides("signal", "velocity")
    assert words.index("velocity first") < words.index("signal first →")


def test_a_mean_of_layers_can_be_drawn() -> None:
    rng = np.random.default_rng(1)
    dims = ("time", "layer", "sector")
    a, b = (xr.DataArray(rng.normal(size=(30, 2, 5)), dims=dims) for _ in range(2))
    by_layer = correlation_by_layer(cross_correlate(a, b, 4, surrogates=19))
    table = by_layer.drop_vars("null").to_dataframe().reset_index().assign(cell=0)
    lines = draw_correlation_curves(stack(2), table)
    np.testing.assert_allclose(np.asarray(lines[1].get_ydata(), float), by_layer["correlation"][1])


def test_tables_that_cannot_be_drawn_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"axes.*2"):
        draw_correlation_curves(stack(2), curves())
    with pytest.raises(ParameterError, match=r"by_layer has no cell 7: it has \[0, 1\]"):
        draw_correlation_curves(stack(4), curves(), cell=7)
    with pytest.raises(ParameterError, match="by_layer lacks the columns lower_quartile"):
        draw_correlation_curves(stack(4), curves().drop(columns="lower_quartile"))
    with pytest.raises(ParameterError, match=r"by_layer must be a table .* got Dataset"):
        draw_correlation_curves(stack(4), xr.Dataset())  # type: ignore[arg-type]


def test_maps_have_one_time_axis() -> None:
    figure = Figure()
    axes = [figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2)]
    signal = np.arange(20.0).reshape(5, 4)
    velocity = signal - 10.0
    options: Any = {"label": "Rac1", "by_velocity": True, "scale": Scale(0.5, 3.0)}
    left, right = draw_map_pair(axes, signal, velocity, **options)
    np.testing.assert_array_equal(left.get_array(), signal.T)
    np.testing.assert_array_equal(right.get_array(), velocity.T)
    assert axes[0].get_xlim() == axes[1].get_xlim() == (-1.5, 13.5)
    assert axes[0].get_ylim() == axes[1].get_ylim()
    assert right.norm.vmin == -right.norm.vmax
    assert [ax.child_axes[0].get_ylabel() for ax in axes] == ["Rac1 (a.u.)", "edge velocity (µm/s)"]
    _, other = draw_map_pair(axes, signal, velocity)
    assert other.get_cmap().name == left.get_cmap().name


def test_maps_of_other_frames_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"signal has shape \(5, 4\), other \(5, 3\)"):
        draw_map_pair(stack(2), np.ones((5, 4)), np.ones((5, 3)))
    with pytest.raises(ParameterError, match=r"axes.*1"):
        draw_map_pair(stack(1), np.ones((5, 4)), np.ones((5, 4)))


def test_what_does_not_survive_is_drawn() -> None:
    """The partial correlation is a line of its own, and a lost peak a cross in place of the dot."""
    table = curves()
    table["correlation_partial"] = 0.03 * table["lag"]
    axes = stack(4)
    lost = peaks(table).assign(q=0.01, geometry=table["layer"] == 0)
    draw_correlation_curves(axes, table, cell=1, peaks=lost)
    for ax, layer in zip(axes, (0, 2, 3, 5), strict=True):
        (thin,) = (line for line in ax.lines if line.get_gid() == PARTIAL_NAME)
        np.testing.assert_allclose(thin.get_ydata(), 0.03 * LAGS)
        assert len(dots(ax)) == (layer != 0)
        assert len([line for line in ax.lines if line.get_gid() == LOST_NAME]) == (layer == 0)
    labels = [handle.get_label() for handle in curve_key(partial="without geometry", lost=True)]
    assert "without geometry" in labels
    assert "lost without geometry" in labels


def test_a_peak_at_a_lag_of_jitter_is_an_open_diamond() -> None:
    table = curves()
    axes = stack(4)
    marks = peaks(table).assign(q=0.01, geometry=False, jittered=table["layer"] == 0)
    draw_correlation_curves(axes, table, cell=1, peaks=marks)
    for ax, layer in zip(axes, (0, 2, 3, 5), strict=True):
        diamonds = [line for line in ax.lines if line.get_gid() == JITTER_NAME]
        assert len(diamonds) == (layer == 0)
        assert all(line.get_markerfacecolor() == "white" for line in diamonds)
    labels = [handle.get_label() for handle in curve_key(jittered=True)]
    assert labels[-1] == "jitter makes this lag"


def test_a_channel_that_is_called_as_a_part_of_the_cell_is_named_as_a_channel() -> None:
    assert sides("edge", "velocity") == "← velocity first  ·  channel edge first →"
    assert sides("Rac1", "Edge", upright=True) == "↓ channel Edge first  ·  ↑ Rac1 first"


def test_the_key_has_the_colour_of_curves_of_the_cytoplasm() -> None:
    plain, of_cytoplasm = (curve_key(cytoplasm_layers=layers)[0].get_color() for layers in (None, 8))
    assert of_cytoplasm == tuple(layer_colours([0, 8], 8)[0])
    assert of_cytoplasm != plain
