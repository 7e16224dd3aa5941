from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.simulate import predicting_movie, wave_movie
from cytodisk.simulate.driven.driven_cell_parameters import DrivenCellParameters
from cytodisk.simulate.driven.driven_movies import DrivenMovie, resting_edge

SMALL: dict[str, Any] = {"radius_px": 15.0, "edge_speed_px": 0.3, "sectors": 12}


def by_sector(movie: DrivenMovie, values: FloatArray, sectors: int) -> FloatArray:
    """Mean of values at boundary points around the angle of each sector, in the image."""
    middle = movie.boundary_yx.mean(axis=(0, 1))
    y, x = (movie.boundary_yx - middle).transpose(2, 0, 1)
    sector = np.round(np.arctan2(y, x) / (2.0 * np.pi) * sectors).astype(int) % sectors
    return np.stack(
        [
            [row[at == k].mean() for k in range(sectors)]
            for row, at in zip(values, sector[: len(values)], strict=True)
        ]
    )


def test_the_edge_moves_as_its_series_says_and_goes_back_to_rest() -> None:
    how = DrivenCellParameters.of(frames=30, radius_px=40.0, edge_speed_px=0.8, sectors=8, relaxation=5.0)
    pushes = np.zeros((30, 8))
    pushes[3, 2] = 1.0
    edge = resting_edge(0, how, pushes)
    reach = np.hypot(*edge.transpose(2, 0, 1)) - np.hypot(*edge[0].T)
    at = np.abs(np.arctan2(*edge[0].T) - np.pi / 2.0).argmin()  # sector 2 of 8: +y
    expected = np.where(np.arange(30) > 3, 0.8 * np.exp(-(np.arange(30) - 4) / 5.0), 0.0)
    np.testing.assert_allclose(reach[:, at], expected, atol=2e-3)
    opposite = np.abs(np.arctan2(*edge[0].T) + np.pi / 2.0).argmin()
    assert np.abs(reach[:, opposite]).max() < 0.01


def test_what_the_source_says_of_the_edge_comes_frames_later() -> None:
    movie = predicting_movie("white", 1, frames=50, strength=0.8, lags=(2,), relaxation=1e6, **SMALL)
    velocity = by_sector(movie, movie.velocity_px[:-1], 12)
    source = movie.series.source.to_numpy()
    found = [np.corrcoef(source[: 49 - lag].ravel(), velocity[lag:].ravel())[0, 1] for lag in (0, 1, 2, 3)]
    np.testing.assert_allclose(found, [0.0, 0.0, 0.8, 0.0], atol=0.1)
    assert movie.truth["gain"] == pytest.approx(-np.log(1.0 - 0.64))


def test_a_channel_is_as_bright_at_the_edge_as_its_series_says_and_deeper_as_another() -> None:
    settings: dict[str, Any] = SMALL | {"radius_px": 30.0, "frames": 6, "depth_px": 8.0, "turn_deg": 30.0}
    movie = predicting_movie("white", 2, coupling="common driver", **settings)
    assert movie.signal.channel.values.tolist() == ["source", "driver"]
    assert movie.masks.dtype == bool
    assert movie.signal.dtype == np.uint16
    row, column = np.indices(movie.masks.shape[1:])
    middle = movie.boundary_yx.mean(axis=(0, 1))
    angle, away = (
        np.arctan2(row - middle[0], column - middle[1]),
        np.hypot(row - middle[0], column - middle[1]),
    )
    for channel in ("source", "driver"):
        found: dict[str, list[float]] = {"edge": [], "inside": []}
        for frame in range(6):
            turned = angle - np.radians(30.0) * frame
            sector = np.round(turned / (2.0 * np.pi) * 12).astype(int) % 12
            image = movie.signal.sel(channel=channel).to_numpy()[frame]
            for name, ring in (
                ("edge", (away > 23) & movie.masks[frame]),
                ("inside", (away > 6) & (away < 17)),
            ):
                found[name] += [image[ring & (sector == k)].mean() / 420.0 - 1.0 for k in range(12)]
        level = movie.series[channel].to_numpy().ravel()
        assert np.corrcoef(found["edge"], level)[0, 1] > 0.9
        assert abs(np.corrcoef(found["inside"], level)[0, 1]) < 0.3
        assert np.polyfit(level, found["edge"], 1)[0] == pytest.approx(0.2 * 400.0 / 420.0, rel=0.2)


def test_a_movie_knows_who_predicts_whom() -> None:
    none, both = (
        predicting_movie("white", 3, frames=2, coupling=word, **SMALL) for word in ("none", "both ways")
    )
    assert none.signal.channel.values.tolist() == both.signal.channel.values.tolist() == ["source"]
    assert none.truth["gain"] == none.truth["gain_back"] == 0.0 < both.truth["gain_back"]


@pytest.mark.parametrize(("mode", "direction"), [(1, 1), (2, -1)])
def test_a_wave_runs_along_the_true_edge_with_the_stated_speed(mode: int, direction: int) -> None:
    settings: dict[str, Any] = SMALL | {"sectors": 24, "relaxation": 3.0, "period_s": 50.0}
    movie = wave_movie("running", 0, frames=31, mode=mode, direction=direction, noise=0.0, **settings)
    velocity = by_sector(movie, movie.velocity_px[:-1], 24)[10:]
    phase = -np.unwrap(np.angle(np.fft.fft(velocity, axis=1)[:, mode]))
    turns = np.polyfit(np.arange(len(phase)) * movie.frame_interval_s, phase / (2.0 * np.pi * mode), 1)[0]
    assert turns == pytest.approx(movie.truth["speed"], rel=0.03)
    length = np.hypot(*np.diff(movie.boundary_yx, axis=1).transpose(2, 0, 1)).sum(axis=1).mean() * 0.16
    assert movie.truth["speed_um_s"] == pytest.approx(turns * length, rel=0.03)


def test_a_wave_runs_inwards_through_the_channel() -> None:
    movie = wave_movie(
        "inward", 1, frames=11, radius_px=30.0, noise=0.0, wavelength_um=3.2, edge_speed_px=0.0
    )
    assert movie.truth["inward_speed_um_s"] == pytest.approx(0.032)  # 1 px a frame
    image = movie.signal.isel(channel=0).to_numpy().astype(float)
    middle = movie.boundary_yx.mean(axis=(0, 1)).round().astype(int)
    ray = image[:, middle[0] - 3 : middle[0] + 4, middle[1] + 4 : middle[1] + 26].mean(axis=1)
    later, earlier = ray[5:, :-5], ray[:-5, 5:]
    assert np.corrcoef(later.ravel(), earlier.ravel())[0, 1] > 0.9
    assert np.corrcoef(ray[5:, 5:].ravel(), ray[:-5, :-5].ravel())[0, 1] < 0.0


def test_the_same_arguments_give_the_same_movie() -> None:
    first, again = (wave_movie("standing", 5, frames=3, **SMALL) for _ in range(2))
    np.testing.assert_array_equal(first.masks, again.masks)
    np.testing.assert_array_equal(first.signal, again.signal)
    assert first.scale == cd.Scale(0.16, 5.0)
    shaken = wave_movie("standing", 5, frames=3, jitter_px=1.0, **SMALL)
    np.testing.assert_allclose(
        np.diff(shaken.boundary_yx, axis=0), np.diff(first.boundary_yx, axis=0), atol=1e-9
    )
    assert shaken.masks.shape != first.masks.shape or np.any(shaken.masks != first.masks)


def test_files_hold_masks_channels_and_scale(tmp_path: Path) -> None:
    movie = predicting_movie("white", 0, frames=2, coupling="common driver", **SMALL)
    masks, signal = movie.write(tmp_path / "some" / "folder")
    np.testing.assert_array_equal(tifffile.imread(masks) > 0, movie.masks)
    with tifffile.TiffFile(signal) as file:
        np.testing.assert_array_equal(file.asarray(), movie.signal)
        assert file.series[0].axes == "TCYX"
        words = str(file.ome_metadata)
    assert all(f'Name="{name}"' in words for name in ("source", "driver"))
    assert 'PhysicalSizeX="0.16"' in words
    assert 'TimeIncrement="5.0"' in words
    with pytest.raises(ParameterError, match="folder must be a path, got int"):
        movie.write(3)  # type: ignore[arg-type]


def test_an_edge_that_would_cross_the_centre_is_refused() -> None:
    with pytest.raises(ParameterError, match="edge_speed_px=5 takes the edge within 0 px of the centre"):
        predicting_movie("slow", 0, frames=60, radius_px=15.0, edge_speed_px=5.0)
    with pytest.raises(ParameterError, match="kind must be one of white"):
        predicting_movie("loud")  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="period_s must be at least two frames"):
        wave_movie("running", period_s=5.0)
