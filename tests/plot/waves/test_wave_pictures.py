"""Pictures of waves: crests lie on the crests, phases have their colours, places and words are right."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
from matplotlib.axes import Axes

import cytodisk as cd
from cytodisk.errors import ParameterError, WindowError
from cytodisk.plot.waves.depth_speeds import draw_depth_speeds
from cytodisk.plot.waves.mode_power import CHANCE_NAME, draw_mode_power
from cytodisk.plot.waves.phase_colours import PHASE_COLOURS, phase_key
from cytodisk.plot.waves.phase_places import WAY_NAME, draw_phase_on_cell, draw_phase_on_disk
from cytodisk.plot.waves.wave_kymograph import draw_wave_kymograph, draw_wave_phase
from cytodisk.plot.waves.wave_spectrum import draw_wave_spectrum
from cytodisk.scale import ShownUnit
from cytodisk.windows.polar_windows import CellWindows

SECTORS, PERIOD = 24, 20.0
TIME, SECTOR = np.arange(60.0)[:, None], np.arange(SECTORS)
PHASE = 2 * np.pi * (TIME / PERIOD - 2 * SECTOR / SECTORS)  # two waves that run towards higher sectors


def test_crests_lie_where_the_values_are_highest(ax: Axes) -> None:
    image, crests = draw_wave_kymograph(ax, np.cos(PHASE), PHASE)
    assert crests is not None
    points = np.concatenate([path.vertices for path in crests.get_paths()])
    assert len(points) > 60
    assert np.allclose(
        np.cos(2 * np.pi * (points[:, 0] / PERIOD - 2 * points[:, 1] / SECTORS)), 1.0, atol=0.02
    )
    assert image.get_array().shape == (SECTORS, 60)
    assert points[:, 1].min() < 0.0  # they go on over the last sector
    assert points[:, 1].max() > SECTORS - 1.0


def test_crests_of_waves_towards_higher_sectors_rise_to_the_right(ax: Axes) -> None:
    _, crests = draw_wave_kymograph(ax, np.cos(PHASE), PHASE, by_velocity=True)
    assert crests is not None
    longest = max(crests.allsegs[0], key=lambda line: np.ptp(line[:, 0]))
    assert np.polyfit(longest[:, 0], longest[:, 1], 1)[0] == pytest.approx(SECTORS / 2 / PERIOD, rel=0.05)


def test_no_crests_without_a_phase(ax: Axes) -> None:
    assert draw_wave_kymograph(ax, np.cos(PHASE))[1] is None
    assert draw_wave_kymograph(ax, np.cos(PHASE), np.full(PHASE.shape, np.nan))[1] is None
    with pytest.raises(ParameterError, match="phase has shape"):
        draw_wave_kymograph(ax, np.cos(PHASE), PHASE[:9])


def test_phase_is_wrapped(ax: Axes) -> None:
    drawn = np.ma.filled(draw_wave_phase(ax, PHASE).get_array(), np.nan)
    assert np.abs(drawn).max() <= np.pi
    assert np.allclose(np.exp(1j * drawn.T), np.exp(1j * PHASE))


def test_the_first_colour_is_the_last() -> None:
    colours = plt.get_cmap(PHASE_COLOURS)
    assert np.allclose(colours(0.0), colours(1.0), atol=0.02)
    bar = phase_key(plt.figure().add_subplot())
    assert [text.get_text() for text in bar.ax.get_yticklabels()] == [
        "lowest",
        "rising",
        "crest",
        "falling",
        "lowest",
    ]
    plt.close()


def test_places_on_the_disk_and_their_arrow(ax: Axes) -> None:
    grid = cd.polar_windows(layers=3, sectors=8)
    phase = np.tile(2 * np.pi * np.arange(8) / 8, (3, 1))
    drawn = draw_phase_on_disk(ax, grid, phase, way=1, number_sectors=True)
    assert len(drawn.get_paths()) == 24
    assert {text.get_text() for text in ax.texts} >= {"0", "2", "4", "6"}
    (arrow,) = [line for line in ax.lines if line.get_gid() == WAY_NAME]
    angle = np.unwrap(np.arctan2(arrow.get_ydata(), arrow.get_xdata()))
    assert (np.diff(angle) > 0).all()  # y points down: clockwise on the page
    ring = draw_phase_on_disk(ax, grid, phase[0], way=-1)
    assert len(ring.get_paths()) == 8
    with pytest.raises(WindowError, match="shape"):
        draw_phase_on_disk(ax, grid, phase[:2])


def test_places_on_the_cell(ax: Axes, windows: CellWindows) -> None:
    phase = 2 * np.pi * np.arange(8) / 8
    phase[3] = np.nan
    lines = draw_phase_on_cell(ax, windows, phase)
    assert len(lines.get_segments()) == 8
    assert np.allclose(lines.get_colors()[3, :3], 0.85)
    assert len(draw_phase_on_cell(ax, windows, np.tile(phase, (3, 1))).get_paths()) == 24
    with pytest.raises(ParameterError, match="has 5 sectors, the windows 8"):
        draw_phase_on_cell(ax, windows, phase[:5])


def test_power_of_modes_with_chance_behind(ax: Axes) -> None:
    modes = pd.DataFrame({"mode": [0, 1, 2], "power": [0.2, 0.7, 0.1], "threshold": [0.4, np.nan, 0.3]})
    bars = draw_mode_power(ax, modes, chosen=1)
    assert [bar.get_height() for bar in bars] == [0.2, 0.7, 0.1]
    colours = [bar.get_facecolor() for bar in bars]
    assert colours[0] == colours[2] != colours[1]
    (chance,) = [one for one in ax.containers if one.get_label() == CHANCE_NAME]
    assert [bar.get_height() for bar in chance] == [0.4, 0.3]
    with pytest.raises(ParameterError, match="lacks the columns power"):
        draw_mode_power(ax, modes[["mode"]])
    with pytest.raises(ParameterError, match="rows of 2 layers"):
        draw_mode_power(ax, modes.assign(layer=[0, 0, 1]))


def test_spectrum_has_a_side_for_each_way(ax: Axes) -> None:
    rows = [(mode, frequency, mode + 2.0) for mode in (-1, 0, 1) for frequency in (0.01, 0.02)]
    table = pd.DataFrame(rows, columns=["mode", "frequency", "power"])
    mesh = draw_wave_spectrum(ax, table, chosen=(1, 0.01))
    assert np.allclose(mesh.get_array(), 100 * np.array([[1.0, 2.0, 3.0]] * 2))
    assert ax.get_xlabel() == "← anticlockwise · mode · clockwise →"
    assert (ax.lines[-1].get_xdata()[0], ax.lines[-1].get_ydata()[0]) == (1, 10.0)
    assert ax.get_ylabel() == "frequency (mHz)"


def test_speeds_by_depth_are_in_the_unit_that_suits(ax: Axes) -> None:
    table = pd.DataFrame(
        {"layer": [1, 0], "depth": [1.5, 0.5], "inward_speed": [0.02, 0.01], "around_speed": [np.nan, -0.1]}
    )
    inwards, around = draw_depth_speeds(ax, table, speed=ShownUnit("µm/min", 60.0))
    assert np.allclose(inwards.get_ydata(), [0.6, 1.2])
    assert np.allclose(around.get_ydata(), [-6.0, np.nan], equal_nan=True)
    assert ax.get_ylabel() == "speed (µm/min)"
