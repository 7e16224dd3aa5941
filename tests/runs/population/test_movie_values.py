from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
import xarray as xr
from scipy.stats import norm

from cytodisk import simulate
from cytodisk.analysis.events import edge_events
from cytodisk.errors import NoValuesError, PopulationError
from cytodisk.runs.correlate.run_correlate import run_correlate
from cytodisk.runs.movie.run_movie import run_movie
from cytodisk.runs.population.movie_values import MOVIE_SUMMARIES, movie_values
from cytodisk.runs.population.movies.event_summaries import around_onsets
from cytodisk.runs.population.movies.time_summaries import mean_velocity, over_time
from cytodisk.runs.predict.prediction_columns import PREDICTION_TABLES
from cytodisk.store.predictions.prediction_store import write_prediction
from cytodisk.store.study import Study
from cytodisk.store.tables import Column
from cytodisk.store.waves.waves_store import write_waves

_COLUMNS: dict[str, tuple[Column, ...]] = {"cells": (), "layers": ()}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("movie")
    truth = simulate.movie("fluctuating", frames=24, radius_px=12)
    tifffile.imwrite(folder / "masks.tif", truth.masks.astype("uint8"), photometric="minisblack")
    tifffile.imwrite(folder / "signal.ome.tif", truth.signal.to_numpy(), metadata={"axes": "TCYX"})
    found = run_movie(
        folder / "masks.tif", folder / "out", signal=folder / "signal.ome.tif", layers=2, sectors=6
    )
    run_correlate(found, "signal 1", max_lag=3, surrogates=19, geometry=False)
    return found


def activity(frames: int = 40, sectors: int = 4) -> xr.Dataset:
    """A quiet cell: the edge moves when it is told to."""
    rng = np.random.default_rng(0)
    places = {"layer": range(2), "sector": range(sectors), "channel": ["a"]}
    return xr.Dataset(
        {
            "mean": (("time", "channel", "layer", "sector"), rng.normal(size=(frames, 1, 2, sectors))),
            "area": (("time", "layer", "sector"), np.full((frames, 2, sectors), 5.0)),
            "velocity": (("time", "sector"), np.zeros((frames, sectors)), {"units": "px/frame"}),
            "status": ("time", np.array(["ok"] * frames, dtype=object)),
        },
        coords=places | {"frame": ("time", np.arange(frames))},
    )


def test_mean_and_sd_are_those_of_frames_with_a_map_and_a_value() -> None:
    cell = activity()
    values = cell["mean"].to_numpy()
    values[3, 0, 0, 0] = np.nan
    values[7] = 1e9
    cell["status"].to_numpy()[7] = "refused"
    kept = np.delete(values, 7, axis=0)
    mean, sd = (over_time(cell, summary, ["a"]) for summary in ("mean", "sd"))
    np.testing.assert_allclose(mean, np.nanmean(kept, axis=0))
    np.testing.assert_allclose(sd, np.nanstd(kept, axis=0, ddof=1))
    assert (mean.attrs["frames"], mean.attrs["of_frames"]) == (39, 40)
    np.testing.assert_array_equal(mean["area"], np.full((2, 4), 5.0))


def test_a_window_with_few_values_has_none_and_a_cell_with_few_frames_says_so() -> None:
    cell = activity(frames=10)
    cell["mean"].to_numpy()[:6, 0, 1, 2] = np.nan
    assert np.isnan(over_time(cell, "mean", ["a"])[0, 1, 2])
    assert np.isfinite(over_time(cell, "mean", ["a"])).sum() == 7
    with pytest.raises(NoValuesError, match="9 of 9 frames have values, the sd over time needs at least 10"):
        over_time(cell.isel(time=slice(9)), "sd", ["a"])


def test_velocity_is_the_mean_step_of_each_sector() -> None:
    cell = activity()
    cell["velocity"][:] = np.arange(4.0)
    cell["velocity"][-1] = np.nan
    found = mean_velocity(cell)
    np.testing.assert_array_equal(found[0, 0], np.arange(4.0))
    assert found["compartment"].item() == "edge"
    assert found.attrs["units"] == "px/frame"


def test_a_pulse_after_each_onset_is_found_and_bleaching_is_not() -> None:
    cell = activity(frames=120, sectors=3)
    velocity, signal = cell["velocity"].to_numpy(), cell["mean"].to_numpy()
    velocity[:] = np.random.default_rng(1).normal(scale=0.01, size=velocity.shape)
    signal[:] = -0.05 * np.arange(120)[:, None, None, None]
    for sector in range(3):
        for onset in range(15 + 5 * sector, 100, 30):
            velocity[onset : onset + 4, sector] = 1.0
            velocity[onset - 1, sector] = -0.001
            signal[onset + 2, 0, 0, sector] += 10.0
    cell["velocity"].to_numpy()[:] = velocity
    assert (edge_events(cell["velocity"])["kind"] == "protrusion").any()
    found = around_onsets(cell, ["a"], reach=5)
    assert found["lag"].to_numpy()[int(np.argmax(found[0, 0].to_numpy()))] == 2.0
    assert found[0, 0].max() > 5.0  # 9 of the 14 events are those that were made
    np.testing.assert_allclose(found[0, 1], 0.0, atol=0.05)  # bleaching alone: 0.5 over the lags


@pytest.mark.slow
def test_each_summary_of_a_study_has_its_shape_and_unit(study: Study) -> None:
    shapes = {
        "mean": (2, 2, 6),
        "sd": (2, 2, 6),
        "velocity": (1, 1, 6),
        "peak_correlation": (1, 2, 6),
    }
    for summary, shape in shapes.items():
        found = movie_values(study, 0, summary)
        assert found.dims == ("channel", "layer", "sector")
        assert found.shape == shape
        assert found.attrs["units"]
    table = study.correlation("signal 1").windows.set_index(["layer", "sector"])["correlation"]
    peaks = movie_values(study, 0, "peak_correlation")[0]
    assert peaks[1, 3] == table[1, 3]


def test_a_lag_counts_where_there_is_a_correlation(study: Study) -> None:
    windows = study.correlation("signal 1").windows
    counts = windows["p"] < 0.05
    if not counts.any():
        with pytest.raises(NoValuesError, match="no window of 'signal 1' correlates"):
            movie_values(study, 0, "lag")
        return
    assert int(movie_values(study, 0, "lag").notnull().sum()) == int(counts.sum())


def test_what_cannot_be_had_says_what_to_type(study: Study, tmp_path: Path) -> None:
    with pytest.raises(PopulationError, match=r"cytodisk correlate .* --signal 'signal 2'"):
        movie_values(study, 0, "peak_correlation", channels=["signal 2"])
    with pytest.raises(PopulationError, match=r"cytodisk correlate .* --with 'signal 2'"):
        movie_values(study, 0, "lag", with_="signal 2")
    with pytest.raises(PopulationError, match=r"'Rac1' is not in study .* it has 'signal 1', 'signal 2'"):
        movie_values(study, 0, "mean", channels=["Rac1"])
    with pytest.raises(PopulationError, match="summary must be one of mean, sd"):
        movie_values(study, 0, "median")
    assert len(MOVIE_SUMMARIES) == 9


def test_gains_of_links_are_those_of_the_tables_in_every_sector(study: Study) -> None:
    with pytest.raises(PopulationError, match="has no prediction: type cytodisk predict"):
        movie_values(study, 0, "gain")
    links = pd.DataFrame(
        {"cell": 0, "source": "signal 1", "target": "velocity", "given": "", "layer": [0, 1]}
    )
    links = links.assign(gain=0.1, gain_excess=[0.02, -0.01], p=[0.05, 0.5], weaker=False)
    cells = pd.DataFrame({"cell": [0, 1], "status": ["ok", "refused"], "reason": ["", "too short"]})
    tables = {"links": links, "cells": cells.assign(surrogates=[19, 0])}
    write_prediction(study.path, ("signal 1", "velocity", ""), tables, PREDICTION_TABLES, {"signals": []})
    found = movie_values(study, 0, "gain")
    assert found["channel"].to_numpy().tolist() == ["signal 1 → velocity"]
    np.testing.assert_array_equal(found[0], np.repeat([[0.02], [-0.01]], 6, axis=1))
    assert found.attrs["units"] == "nat"
    score = movie_values(study, 0, "gain_score")[0, :, 3]
    np.testing.assert_allclose(score, [norm.isf(0.025), norm.isf(0.475)])
    with pytest.raises(NoValuesError, match="too short"):
        movie_values(study, 1, "gain")
    with pytest.raises(PopulationError, match="link 'velocity → signal 1' was not tested"):
        movie_values(study, 0, "gain", channels=["velocity → signal 1"])


def test_waves_have_an_order_by_layer_and_numbers_without_sign(study: Study) -> None:
    with pytest.raises(PopulationError, match="has no waves of 'velocity': type cytodisk waves"):
        movie_values(study, 0, "waves")
    layers = pd.DataFrame({"cell": [0], "layer": pd.array([None], "Int64"), "order": [0.4], "p": [0.05]})
    cells = layers.assign(status="ok", reason="", period_s=90.0, persistence_s=300.0)
    cells = cells.assign(speed_um_s=-0.2, direction=-0.9, p=0.04, kind="rotating")
    write_waves(study.path, "velocity", {"cells": cells, "layers": layers}, _COLUMNS, {})
    found = movie_values(study, 0, "waves")
    assert found["compartment"].to_numpy().tolist() == ["edge"]
    np.testing.assert_array_equal(found[0, 0], np.full(6, 0.4))
    numbers = found.attrs["numbers"]
    assert numbers["wave_speed_um_s"] == 0.2
    assert numbers["wave_direction"] == 0.9
    assert numbers["wave_order"] == 0.4
    with pytest.raises(PopulationError, match="waves are compared of one signal at a time"):
        movie_values(study, 0, "waves", channels=["velocity", "signal 1"])
