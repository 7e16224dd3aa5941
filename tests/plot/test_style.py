import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from cytodisk.errors import ParameterError
from cytodisk.plot import style
from cytodisk.plot.style import colour_bar, colour_map, nice_length, paper_style, scale_bar, signal_limits
from cytodisk.scale import Scale


@given(st.floats(1e-6, 1e9))
def test_nice_length_is_the_longest_round_one(longest: float) -> None:
    length = nice_length(longest)
    mantissa = length / 10.0 ** np.floor(np.log10(length) + 1e-9)
    assert np.isclose(mantissa, [1, 2, 5]).any()
    assert 0.4 * longest - 1e-12 <= length <= longest * (1 + 1e-8)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.inf, np.nan])
def test_nice_length_refuses(wrong: float) -> None:
    with pytest.raises(ParameterError, match="longest must be a positive number"):
        nice_length(wrong)


@pytest.mark.parametrize(
    ("pixel_size", "words", "pixels"), [(None, "20 px", 20), (0.25, "5 µm", 20), (2.0, "50 µm", 25)]
)
def test_scale_bar_is_as_long_as_it_says(
    ax: Axes, pixel_size: float | None, words: str, pixels: float
) -> None:
    ax.set_xlim(0, 90)
    bar, text = scale_bar(ax, Scale(pixel_size))
    assert np.ptp(bar.get_xdata()) == pytest.approx(pixels)
    assert text.get_text() == words


def test_a_second_scale_bar_replaces_the_first(ax: Axes) -> None:
    ax.set_xlim(0, 90)
    scale_bar(ax)
    _, text = scale_bar(ax, Scale(0.25))
    assert len(ax.lines) == 1
    assert list(ax.texts) == [text]


def test_signal_limits_look_inside_the_cell_only() -> None:
    image, mask = np.full((10, 110), 1e6), np.zeros((10, 110), dtype=bool)
    mask[:, :101] = True
    image[:, :101] = np.arange(101)
    assert signal_limits(image, mask) == pytest.approx((1.0, 99.5), abs=0.6)


@pytest.mark.parametrize("value", [0.0, 7.0, -3.0])
def test_signal_limits_of_a_constant_stay_apart(value: float) -> None:
    low, high = signal_limits(np.full((4, 4), value))
    assert low < value < high


def test_signal_limits_of_nothing() -> None:
    assert signal_limits(np.full((4, 4), np.nan), np.ones((4, 4), dtype=bool)) == (0.0, 1.0)


def test_colour_map_refuses_an_unknown_name() -> None:
    with pytest.raises(ParameterError, match="'no such' is not a colour map"):
        colour_map("no such")


def test_colour_bar_says_label_and_unit(ax: Axes) -> None:
    assert ax.figure is not None
    filled = PolyCollection([], array=np.array([0.0, 1.0]))
    bar = colour_bar(filled, ax, "a$b", "a.u.")
    assert bar.ax.get_ylabel() == "a$b (a.u.)"


def test_paper_style_ends_with_its_block() -> None:
    import matplotlib as mpl

    before = mpl.rcParams["font.size"]
    with paper_style():
        assert 7 <= mpl.rcParams["font.size"] <= 8
    assert mpl.rcParams["font.size"] == before


def test_sizes_of_text_stand_in_the_style_alone() -> None:
    folder = Path(style.__file__).parents[1]
    own = re.compile(r"\b(?:font)?size=\d|\"fontsize\": *\d")
    found = [
        f"{path.name}: {line.strip()}"
        for part in ("pages", "plot")
        for path in (folder / part).rglob("*.py")
        if path.name != "style.py"
        for line in path.read_text(encoding="utf-8").splitlines()
        if own.search(line) and ">>>" not in line
    ]
    assert found == []
