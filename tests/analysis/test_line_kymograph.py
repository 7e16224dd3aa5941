from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from cytodisk.analysis.kymograph import bilinear, line_kymograph
from cytodisk.errors import ParameterError, SignalError


def gradient(frames: int = 4, height: int = 20, width: int = 30) -> np.ndarray:
    """10 counts a row, 1 a column, 1000 a frame."""
    t, y, x = np.mgrid[:frames, :height, :width]
    return np.asarray(1000.0 * t + 10.0 * y + x)


def test_a_slanted_line_over_a_gradient() -> None:
    kymograph = line_kymograph([(2.0, 3.0), (8.0, 11.0)], gradient())  # 10 px long: 0.6 down, 0.8 right
    assert kymograph.dims == ("time", "distance")
    distance = np.arange(11.0)
    np.testing.assert_allclose(kymograph["distance"], distance)
    np.testing.assert_allclose(kymograph["y"], 2.0 + 0.6 * distance)
    np.testing.assert_allclose(kymograph["x"], 3.0 + 0.8 * distance)
    expected = 1000.0 * np.arange(4)[:, None] + 23.0 + 6.8 * distance
    np.testing.assert_allclose(kymograph, expected)
    assert kymograph["distance"].attrs["units"] == "px"
    assert "time_s" not in kymograph.coords


def test_a_line_with_corners_goes_on_around_them() -> None:
    line = [(5, 2), (5, 2), (5, 6), (12, 6)]  # the repeated point counts for nothing
    kymograph = line_kymograph(line, gradient(1), spacing_px=1.5)
    expected = [(5, 2), (5, 3.5), (5, 5), (5.5, 6), (7, 6), (8.5, 6), (10, 6), (11.5, 6)]
    np.testing.assert_allclose(np.column_stack([kymograph["y"], kymograph["x"]]), expected)
    np.testing.assert_allclose(kymograph[0], [10 * y + x for y, x in expected])
    np.testing.assert_allclose(kymograph["distance"], 1.5 * np.arange(8))


@pytest.mark.parametrize("spacing", [0.1, 0.3, 1 / 3, 0.7])
def test_the_end_of_a_whole_number_of_steps_is_a_place(spacing: float) -> None:
    line = [(3.0, 1.0), (3.0, 1.0 + 30 * spacing)]
    kymograph = line_kymograph(line, gradient(1), spacing_px=spacing)
    assert kymograph.sizes["distance"] == 31


def test_the_width_is_averaged_across_the_line() -> None:
    image = np.zeros((1, 15, 15))
    image[0, 7, :] = 9.0
    image[0, 8, :] = 30.0
    along = [(7, 2), (7, 12)]
    for width, value in ((1, 9.0), (2, 0.5 * (4.5 + 19.5)), (3, 13.0), (5, 39.0 / 5)):
        np.testing.assert_allclose(line_kymograph(along, image, width_px=width), value)
    across = line_kymograph([(2, 7), (12, 7)], image, width_px=3)
    np.testing.assert_allclose(across[0, 5:7], [9.0, 30.0])


def test_a_bright_line_that_moves() -> None:
    images = np.zeros((6, 12, 40), dtype=np.uint16)
    for time in range(6):
        images[time, :, 5 + 4 * time] = 1000
    kymograph = line_kymograph([(6, 2), (6, 38)], images, width_px=3)
    assert kymograph.argmax("distance").to_numpy().tolist() == [3, 7, 11, 15, 19, 23]
    assert (kymograph.sum("distance") == 1000.0).all()


def test_scale_and_channels_come_from_the_image() -> None:
    values = np.stack([gradient(), -gradient()], axis=1)
    attrs = {"pixel_size_um": 0.2, "frame_interval_s": 3.0}
    signals = xr.DataArray(values, {"channel": ["a", "b"]}, ("time", "channel", "y", "x"), attrs=attrs)
    kymograph = line_kymograph([(4, 2), (4, 12)], signals, spacing_px=2.0)
    assert kymograph.dims == ("time", "distance", "channel")
    np.testing.assert_allclose(kymograph["distance"], 0.4 * np.arange(6))
    assert kymograph["distance"].attrs["units"] == "µm"
    np.testing.assert_allclose(kymograph["time_s"], 3.0 * np.arange(4))
    np.testing.assert_array_equal(kymograph.sel(channel="a"), -kymograph.sel(channel="b"))
    one = line_kymograph([(4, 2), (4, 12)], signals.sel(channel="a"), spacing_px=2.0)
    assert one.dims == ("time", "distance")
    turned = line_kymograph([(4, 2), (4, 12)], signals.transpose("x", "time", "channel", "y"), spacing_px=2.0)
    assert turned.identical(kymograph)


def test_frames_may_come_one_by_one() -> None:
    frames = list(gradient())
    np.testing.assert_array_equal(
        line_kymograph([(0, 0), (19, 29)], frames), line_kymograph([(0, 0), (19, 29)], gradient())
    )


def test_nan_is_only_where_it_has_a_share() -> None:
    image = gradient(1)
    image[0, 5, 10] = np.nan
    image[0, 3, 10] = np.inf
    known = np.isfinite(line_kymograph([(4, 5), (4, 15)], image)[0])  # row 4 touches neither 5 nor 3
    assert known.all()
    known = np.isfinite(line_kymograph([(5, 5), (5, 15)], image)[0])
    assert known.to_numpy().tolist() == [True] * 5 + [False] + [True] * 5
    known = np.isfinite(line_kymograph([(4.5, 5.5), (4.5, 14.5)], image)[0])
    assert known.to_numpy().tolist() == [True] * 4 + [False] * 2 + [True] * 4


def test_bilinear_beyond_the_outermost_centres() -> None:
    image = gradient(1)[0]
    points = np.array([[-0.5, 3.0], [19.5, 29.5], [0.0, 0.0], [19.0, 29.0], [np.nan, 1.0]])
    np.testing.assert_allclose(bilinear(image, points), [3.0, 219.0, 0.0, 219.0, np.nan])
    np.testing.assert_allclose(bilinear(np.full((1, 1), 7.0), points[:3]), 7.0)


LINE = [(2, 2), (8, 8)]


@pytest.mark.parametrize(
    ("line", "options", "message"),
    [
        ([(2, 2)], {}, "two or more points .* got shape"),
        ([2, 3, 4], {}, r"got shape \(3,\)"),
        ([(1, 2, 3), (4, 5, 6)], {}, r"got shape \(2, 3\)"),
        ([(1, 2), (3, np.nan)], {}, "finite"),
        ("line", {}, "two or more points"),
        ([(1, 2), (1, 2)], {}, "has no length"),
        (
            [(2, 2), (2, 29.5)],
            {"spacing_px": 0.5},
            r"leaves the image at \(row, column\) \(2.0, 29.5\).*\(19, 29\)",
        ),
        ([(-1, 2), (5, 2)], {}, r"leaves the image at \(row, column\) \(-1.0, 2.0\)"),
        ([(0, 2), (0, 9)], {"width_px": 3}, "leaves the image .* width_px is 3"),
        (LINE, {"width_px": 0}, "width_px must be a whole number from 1 to 10000, got 0"),
        (LINE, {"width_px": 1.5}, "width_px"),
        (LINE, {"spacing_px": 0.0}, "spacing_px must be a number from 0.001 to 1e\\+06, got 0.0"),
        (LINE, {"spacing_px": "1"}, "spacing_px"),
    ],
)
def test_lines_that_make_no_sense_are_refused(line: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        line_kymograph(line, gradient(), **options)


@pytest.mark.parametrize(
    ("signals", "message"),
    [
        (gradient()[0], r"frame of the signals has shape \(30,\)"),
        (np.zeros((2, 2, 2, 9, 9)), r"shape \(2, 2, 9, 9\)"),
        (7, "got int"),
        ([], "frames of a movie"),
        ("movie.tif", r"got the path 'movie\.tif': read it, as cd\.read_image"),
        (Path("movie.tif"), r"got the path .*movie\.tif.*read_image"),
        (np.zeros((3, 9, 9), dtype=complex), "numbers"),
        ([np.zeros((9, 9)), np.zeros((9, 8))], r"frame 1 of the signals has shape \(9, 8\)"),
        (xr.DataArray(np.zeros((9, 9)), dims=("y", "x")), r"dims \['y', 'x'\]"),
        (xr.DataArray(np.zeros((3, 9, 9)), dims=("time", "z", "x")), "dims"),
    ],
)
def test_signals_that_are_no_movie_are_refused(signals: Any, message: str) -> None:
    with pytest.raises(SignalError, match=message):
        line_kymograph(LINE, signals)


def test_a_scale_that_is_none_is_refused() -> None:
    signals = xr.DataArray(gradient(), dims=("time", "y", "x"), attrs={"pixel_size_um": -1})
    with pytest.raises(ParameterError, match=r"pixel_size_um.*-1"):
        line_kymograph(LINE, signals)
