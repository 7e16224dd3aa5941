"""Profiles, SuperPlots, effect sizes, directions, pooled curves and power."""

import itertools

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from scipy import stats

from cytodisk.errors import ParameterError
from cytodisk.plot.population import super_plot
from cytodisk.plot.population.condition_looks import condition_colours, experiment_looks
from cytodisk.plot.population.condition_profiles import condition_key, draw_condition_profiles
from cytodisk.plot.population.directions import EXPERIMENT_NAME, MEAN_NAME, draw_directions
from cytodisk.plot.population.effect_sizes import INTERVAL_NAME, draw_effect_sizes
from cytodisk.plot.population.experiment_key import experiment_key
from cytodisk.plot.population.experiment_lines import CELL_NAME, interval_of_mean, mean_by_experiment
from cytodisk.plot.population.pooled_curve_lines import draw_pooled_curves
from cytodisk.plot.population.power_curves import draw_power
from cytodisk.plot.population.super_plot import draw_super_plot


def lines(ax: Axes, name: str) -> list[Line2D]:
    return [line for line in ax.lines if line.get_gid() == name]


def scalar_cells(paired: bool = True) -> pd.DataFrame:
    rows = pd.DataFrame(itertools.product(["control", "drug"], ["a", "b", "c"], range(5)))
    rows.columns = ["condition", "experiment", "number"]
    rows["size"] = 1.0 * rows["number"] + 10.0 * (rows["condition"] == "drug")
    return rows if paired else rows.assign(experiment=rows["condition"] + rows["experiment"])


def test_intervals_are_those_of_student() -> None:
    values = np.random.default_rng(0).normal(size=(5, 3))
    values[1, 2] = np.nan
    mean, low, high = interval_of_mean(values)
    for k in range(3):
        own = values[np.isfinite(values[:, k]), k]
        expected = stats.t.interval(0.95, len(own) - 1, own.mean(), stats.sem(own))
        assert (low[k], high[k]) == pytest.approx(expected)
        assert mean[k] == pytest.approx(own.mean())
    mean, low, high = interval_of_mean(values[:1])
    assert np.isnan(low).all()
    assert mean[0] == values[0, 0]


def test_experiments_count_alike_however_many_cells_they_have() -> None:
    names, means = mean_by_experiment(np.array([[1.0], [3.0], [np.nan], [10.0]]), list("aaab"))
    assert names == ["a", "b"]
    assert means.tolist() == [[2.0], [10.0]]


def test_looks_say_which_experiments_are_the_same() -> None:
    shared = experiment_looks(scalar_cells(), shared=True)
    assert shared["control", "a"] == shared["drug", "a"]
    assert len({look.mark for look in shared.values()}) == 3
    own = experiment_looks(scalar_cells(paired=False), shared=False)
    assert own["control", "controla"].colour != own["drug", "druga"].colour
    assert own["control", "controla"].mark == own["drug", "druga"].mark
    assert len(set(condition_colours([str(k) for k in range(20)]).values())) == 20


def test_a_profile_has_its_edge_on_the_right(ax: Axes) -> None:
    rows = pd.DataFrame(itertools.product(["control", "drug"], ["a", "b"], range(3)))
    rows.columns = ["condition", "experiment", "layer"]
    rows["value"] = [1.0, 2.0, 3.0, 3.0, 4.0, 5.0] * 2
    depths = xr.DataArray([0.5, 1.5, 3.0], dims="layer", attrs={"units": "µm"})
    control, drug = draw_condition_profiles(ax, rows, depths=depths, label="GFP")
    assert (control.get_label(), drug.get_label()) == ("control", "drug")
    assert np.asarray(control.get_xdata()).tolist() == [2.5, 1.5, 0.5]
    assert np.asarray(control.get_ydata()).tolist() == [2.0, 3.0, 4.0]
    assert [text.get_text() for text in ax.get_xticklabels()] == ["0\n0.5", "1\n1.5", "2\n3"]
    assert "µm" in ax.get_xlabel()
    assert len(lines(ax, "experiment")) == 4
    assert len([one for one in ax.collections if one.get_gid() == "interval"]) == 2
    assert {"centre", "edge of the cell"} == {text.get_text() for text in ax.texts}
    assert len(condition_key([control, drug], cells=True)) == 5


def test_a_profile_marks_the_nucleus(ax: Axes) -> None:
    rows = pd.DataFrame({"condition": "x", "experiment": "a", "layer": [0, 1, 2], "value": 1.0})
    depths = xr.DataArray(
        [0.5, 1.5, np.nan],
        dims="layer",
        coords={"compartment": ("layer", ["cytoplasm", "cytoplasm", "nucleus"])},
    )
    (line,) = draw_condition_profiles(ax, rows, depths=depths)
    assert {"nucleus", "cytoplasm", "membrane"} == {text.get_text() for text in ax.texts}
    assert not ax.collections  # one experiment has no interval
    assert len(np.asarray(line.get_xdata())) == 3


def test_a_super_plot_has_a_dot_a_cell_and_a_mark_an_experiment(ax: Axes) -> None:
    tests = pd.DataFrame(
        {"condition": ["drug"], "p": [0.25], "effect_size": [2.0], "low": [-0.5], "high": [4.5]}
    )
    dots = draw_super_plot(ax, scalar_cells(), "size", tests=tests, label="size (µm)")
    assert [len(one.get_offsets()) for one in dots] == [15, 15]
    means = lines(ax, super_plot.EXPERIMENT_NAME)
    assert [float(np.asarray(mark.get_ydata())[0]) for mark in means] == [2.0] * 3 + [12.0] * 3
    assert len({float(np.asarray(mark.get_xdata())[0]) for mark in means}) == 6
    pairs = lines(ax, super_plot.PAIR_NAME)
    assert [np.asarray(line.get_ydata()).tolist() for line in pairs] == [[2.0, 12.0]] * 3
    written = [text.get_text() for text in ax.texts if text.get_gid() == super_plot.TEST_NAME]
    assert written == ["p = 0.25\ng = 2 [−0.5, 4.5]"]
    assert ax.get_ylabel() == "size (µm)"


def test_unpaired_experiments_are_not_joined(ax: Axes) -> None:
    draw_super_plot(ax, scalar_cells(paired=False), "size", conditions=["drug", "control"])
    assert not lines(ax, super_plot.PAIR_NAME)
    assert [text.get_text() for text in ax.get_xticklabels()] == ["drug", "control"]
    faces = {mark.get_markerfacecolor() for mark in lines(ax, super_plot.EXPERIMENT_NAME)}
    assert len(faces) == 2
    assert len(experiment_key(scalar_cells())) == 5
    assert len(experiment_key(scalar_cells(paired=False))) == 4


def test_an_interval_does_not_dwarf_the_cells(ax: Axes) -> None:
    """Two experiments that differ give an interval of 12.7 standard errors on either side."""
    rows = scalar_cells()
    rows = rows[rows["experiment"] != "c"]
    rows["size"] += 3.0 * (rows["experiment"] == "b")
    nothing = {"condition": ["drug"], "p": [1.0], "effect_size": [np.nan], "low": [np.nan], "high": [np.nan]}
    draw_super_plot(ax, rows, "size", tests=pd.DataFrame(nothing))
    assert ax.get_ylim() == pytest.approx((-1.02, 18.02))
    written = [text.get_text() for text in ax.texts if text.get_gid() == super_plot.TEST_NAME]
    assert written == ["p = 1"]


def test_cells_without_the_number_and_many_cells(ax: Axes) -> None:
    rows = scalar_cells()
    rows.loc[:3, "size"] = np.nan
    many = pd.concat([rows] * 300)
    dots = draw_super_plot(ax, many, "size")
    assert len(dots[0].get_offsets()) == 1500
    values = np.asarray(dots[0].get_offsets())[:, 1]
    assert (values.min(), values.max()) == (0.0, 4.0)
    rows["size"] = np.nan
    dots = draw_super_plot(ax, rows, "size")
    assert [len(one.get_offsets()) for one in dots] == [0, 0]


def test_effect_sizes_are_filled_where_they_are_significant(ax: Axes) -> None:
    scalars = pd.DataFrame(
        {
            "scalar": ["polarity", "area", "nothing"],
            "effect_size": [1.5, 0.2, np.nan],
            "low": [0.5, -30.0, np.nan],
            "high": [2.5, 30.0, np.nan],
            "p_fwer": [0.01, 0.9, np.nan],
        }
    )
    first, second = draw_effect_sizes(ax, scalars)
    assert to_rgba(first.get_markerfacecolor()) != to_rgba("white")
    assert to_rgba(second.get_markerfacecolor()) == to_rgba("white")
    assert [text.get_text() for text in ax.get_yticklabels()] == ["polarity", "area", "nothing"]
    assert ax.get_ylim()[0] > ax.get_ylim()[1]
    reach = ax.get_xlim()[1]
    assert 2.5 < reach < 10.0  # the long interval is cut off, and says so
    assert len(lines(ax, INTERVAL_NAME)) == 2
    assert [line.get_marker() for line in ax.lines].count("<") == 1
    assert [text.get_text() for text in ax.texts] == ["0.01", "0.9"]
    several = draw_effect_sizes(Figure().add_subplot(), scalars.assign(p_holm=[0.06, 0.9, np.nan]))
    assert to_rgba(several[0].get_markerfacecolor()) == to_rgba("white")


def test_directions_have_their_resultants(ax: Axes) -> None:
    dots = draw_directions(ax, [0.0, 90.0, 90.0, 90.0, np.nan], experiments=list("aabbb"))
    assert len(dots.get_offsets()) == 4
    radii = np.hypot(*np.asarray(dots.get_offsets()).T)
    assert len(np.unique(radii.round(6))) == 3  # those of one direction are stacked
    ends = {name: [] for name in (EXPERIMENT_NAME, MEAN_NAME)}  # type: ignore[var-annotated]
    for text in ax.texts:
        if text.get_gid() in ends:
            ends[text.get_gid()].append(text.xy)  # type: ignore[attr-defined, index]
    assert np.allclose(ends[EXPERIMENT_NAME], [[0.5, 0.5], [0.0, 1.0]])
    assert np.allclose(ends[MEAN_NAME], [[0.25, 0.75]])
    words = ax.texts[-1].get_text()
    assert words == "resultant length 0.79\n4 cells, 2 experiments\n1 without a direction"


def test_very_many_directions_are_a_rose_alone(ax: Axes) -> None:
    dots = draw_directions(ax, np.linspace(0.0, 359.0, 400))
    assert len(dots.get_offsets()) == 0
    assert sum(patch.get_gid() == "rose" for patch in ax.patches) == 24
    assert ax.texts[-1].get_text() == "resultant length 0.00\n400 cells"


def test_no_direction_at_all(ax: Axes) -> None:
    draw_directions(ax, [np.nan, np.nan])
    assert ax.texts[-1].get_text() == "0 cells\n2 without a direction"
    with pytest.raises(ParameterError, match="one number a cell"):
        draw_directions(ax, [0.0, 1.0], experiments=["a"])


def test_pooled_curves_are_means_of_experiments(ax: Axes) -> None:
    lag = ("lag", [-5.0, 0.0, 5.0], {"units": "s"})
    curves = xr.DataArray(
        np.array([[0.0, 1.0, 0.0], [0.0, 3.0, 0.0], [0.0, 8.0, 0.0]]), {"lag": lag}, ("cell", "lag")
    )
    cells = pd.DataFrame({"condition": "control", "experiment": list("aab")})
    (mean,) = draw_pooled_curves(ax, curves, cells, signal="Rac1")
    assert np.asarray(mean.get_ydata()).tolist() == [0.0, 5.0, 0.0]
    assert ax.get_xlabel().startswith("lag (s)")
    (faint,) = [
        one for one in ax.collections if isinstance(one, LineCollection) and one.get_gid() == CELL_NAME
    ]
    assert len(faint.get_segments()) == 3
    with pytest.raises(ParameterError, match="2 rows for 3 curves"):
        draw_pooled_curves(ax, curves, cells[:2])
    with pytest.raises(ParameterError, match="dims cell and lag"):
        draw_pooled_curves(ax, curves.rename(cell="unit"), cells)


def test_power_has_a_line_an_effect(ax: Axes) -> None:
    power = pd.DataFrame(itertools.product([3, 5], [0.5, 1.0]), columns=["experiments", "effect"])
    power["window"] = [0.1, 0.2, 0.3, 0.3]
    small, large = draw_power(ax, power)
    assert np.asarray(small.get_ydata()).tolist() == [0.1, 0.3]
    assert (small.get_label(), large.get_label()) == ("0.5", "1")
    heights = [text.xy[1] for text in ax.texts[:2]]  # type: ignore[attr-defined]
    assert abs(heights[1] - heights[0]) > 0.04  # labels of lines that end together stay apart
    with pytest.raises(ParameterError, match="no column 'scalar'"):
        draw_power(ax, power, "scalar")
    with pytest.raises(ParameterError, match="select one design"):
        draw_power(ax, pd.concat([power, power]))


@pytest.mark.parametrize("wrong", [{"condition": ["a"]}, {"condition": [], "experiment": [], "size": []}])
def test_tables_that_lack_something_are_refused(ax: Axes, wrong: dict[str, list[str]]) -> None:
    with pytest.raises(ParameterError, match="cells has no"):
        draw_super_plot(ax, pd.DataFrame(wrong), "size")
