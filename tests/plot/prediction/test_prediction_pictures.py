"""Pictures of predictions show the numbers of their tables."""

from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.plot.prediction.drawn_links import drawn_links, layers_words
from cytodisk.plot.prediction.link_looks import FAINT_COLOUR, LESS_COLOUR, MORE_COLOUR, percent, percent_words

THERE, BACK = ("Rac1", "velocity"), ("velocity", "Rac1")


def row(pair: tuple[str, str], layer: int, gain: float, q: float, **more: Any) -> dict[str, Any]:
    known = {"cell": 0, "source": pair[0], "target": pair[1], "layer": layer, "gain": gain, "q": q}
    return known | {"effect": 0.3, "threshold": 0.01, "gain_partial": np.nan, "geometry": False} | more


@pytest.fixture
def links() -> pd.DataFrame:
    return pd.DataFrame(
        [
            row(THERE, 0, 0.5, 0.01, gain_partial=0.2),
            row(THERE, 1, 0.05, 0.02, effect=-0.1),
            row(THERE, 2, 0.002, 0.6),
            row(BACK, 0, 0.03, 0.04, geometry=True, effect=-0.2),
            row(BACK, 1, np.nan, np.nan),
            row(BACK, 2, 0.001, 0.9),
        ]
    )


def words(ax: Axes) -> list[str]:
    return [text.get_text() for text in ax.texts]


def test_gains_are_percent_of_the_squared_error() -> None:
    np.testing.assert_allclose(percent([0.0, -0.1, np.log(2.0)]), [0.0, 0.0, 50.0])
    assert (percent_words(0.0431), percent_words(1.31)) == ("4.2 %", "73 %")
    assert layers_words([0, 1, 2, 5]) == "layers 0–2, 5"
    assert layers_words([3]) == "layer 3"


def test_links_that_are_drawn(links: pd.DataFrame) -> None:
    there, back = drawn_links(links)
    assert (there.pair, there.layers, there.gain, there.doubtful) == (THERE, (0, 1), 0.5, False)
    assert (back.layers, back.doubtful) == ((0,), True)


def test_arrows_end_in_points_or_bars(ax: Axes, links: pd.DataFrame) -> None:
    links.loc[3, "geometry"] = False
    more, less = cd.plot.draw_network(ax, links, ["Rac1", "velocity"], names={"velocity": "edge velocity"})
    assert "CurveFilledB" in type(more.get_arrowstyle()).__name__
    assert "BarAB" in type(less.get_arrowstyle()).__name__
    assert to_hex(more.get_edgecolor()).upper() == MORE_COLOUR
    assert to_hex(less.get_edgecolor()).upper() == LESS_COLOUR
    assert more.get_linewidth() > less.get_linewidth()
    assert words(ax) == ["Rac1", "edge velocity", "39 %\nlayers 0–1", "3 %\nlayer 0"]


def test_what_does_not_survive_is_a_broken_grey_line(ax: Axes, links: pd.DataFrame) -> None:
    _, lost = cd.plot.draw_network(ax, links, ["Rac1", "RhoA", "velocity"])
    assert to_hex(lost.get_edgecolor()) == to_hex(FAINT_COLOUR)
    assert lost.get_linestyle() != "-"
    assert len(cd.plot.network_key(doubtful=True)) == 1 + len(cd.plot.network_key())


def test_what_noise_may_have_made_does_not_count(ax: Axes, links: pd.DataFrame) -> None:
    links = links.assign(geometry=False, weaker=[True, True, False, False, False, False])
    weaker, back = drawn_links(links)
    assert (weaker.doubtful, back.doubtful) == (True, False)
    assert cd.plot.draw_network(ax, links, ["Rac1", "velocity"])[0].get_linewidth() < 1.0


def test_names_lie_apart_and_the_last_at_the_bottom(ax: Axes, links: pd.DataFrame) -> None:
    signals = ["Rac1", "RhoA", "Cdc42", "actin", "velocity"]
    cd.plot.draw_network(ax, links, signals)
    places = {text.get_text(): text.get_position() for text in ax.texts[:5]}
    assert min(places, key=lambda name: places[name][1]) == "velocity"
    apart = [np.hypot(*np.subtract(places[a], places[b])) for a in signals for b in signals if a < b]
    assert min(apart) > 0.8
    with pytest.raises(ParameterError, match="signals must be two or more, got 1"):
        cd.plot.draw_network(ax, links, ["Rac1"])


def test_squares_by_layer(ax: Axes, links: pd.DataFrame) -> None:
    first, second, lost = cd.plot.draw_link_layers(ax, links)
    assert first.get_width() > second.get_width()
    assert [to_hex(one.get_facecolor()).upper() for one in (first, second)] == [MORE_COLOUR, LESS_COLOUR]
    assert lost.get_facecolor()[3] == 0.0
    assert [label.get_text() for label in ax.get_yticklabels()] == ["Rac1 → velocity", "velocity → Rac1"]
    dots = [line for line in ax.lines if line.get_marker() == "."]
    assert len(dots) == 2  # the layer that was not tested has none


def test_the_profile_shows_both_directions(ax: Axes, links: pd.DataFrame) -> None:
    depths = xr.DataArray([[0.5, 1.5, 2.5]], dims=("time", "layer"), attrs={"units": "µm"})
    depths = depths.assign_coords(layer=[0, 1, 2])
    there, back = cd.plot.draw_gain_profile(ax, links, depths=depths)
    np.testing.assert_allclose(there.get_ydata(), [39.35, 4.877, 0.1998], rtol=1e-3)
    assert np.isnan(back.get_ydata()[1])
    assert ax.get_yscale() == "log"
    assert [label.get_text() for label in ax.get_xticklabels()] == ["0\n0.5", "1\n1.5", "2\n2.5"]
    crosses = [line for line in ax.lines if line.get_marker() == "x" and len(line.get_xdata())]
    np.testing.assert_allclose(crosses[0].get_ydata(), percent([0.03]))
    bars = [line for line in ax.lines if line.get_marker() == "_"]
    np.testing.assert_allclose(bars[0].get_ydata()[0], percent(0.2))


def test_keys_name_what_is_drawn(links: pd.DataFrame) -> None:
    key = cd.plot.gain_key([THERE, BACK], names={"velocity": "edge"}, partial="without geometry", lost=True)
    labels = [handle.get_label() for handle in key]
    assert labels[:2] == ["Rac1 → edge", "edge → Rac1"]
    assert labels[-2:] == ["without geometry", "not counted"]
    Figure().legend(handles=key)


def test_coefficients_by_lag(ax: Axes) -> None:
    rows = [
        {"cell": 0, "source": "Rac1", "target": "velocity", "layer": 0, "lag": lag, "lag_s": 5.0 * lag}
        | {"coefficient": value, "low": value - 0.1, "high": value + 0.1}
        for lag, value in ((1, 0.3), (2, -0.2))
    ]
    lags = pd.DataFrame(rows)
    drawn = cd.plot.draw_lag_coefficients(ax, lags, THERE, 0, sure=False)
    assert drawn is not None
    np.testing.assert_allclose(drawn.lines[0].get_xydata(), [[5.0, 0.3], [10.0, -0.2]])
    assert drawn.lines[0].get_markerfacecolor() == "white"
    assert ax.get_xlabel() == "source earlier by (s)"
    assert cd.plot.draw_lag_coefficients(ax, lags, THERE, 1) is None
    with pytest.raises(ParameterError, match="pair velocity → Rac1 is not in the table: it has Rac1 → vel"):
        cd.plot.draw_lag_coefficients(ax, lags, BACK, 0)
    with pytest.raises(ParameterError, match="lags has no cell 4"):
        cd.plot.draw_lag_coefficients(ax, lags, THERE, 0, cell=4)
    with pytest.raises(ParameterError, match="links lacks the columns"):
        cd.plot.draw_network(ax, lags, ["Rac1", "velocity"])
