"""Correlating a study: the tables hold what the functions give, whatever its cells are like."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from movie_files import write_masks, write_movie

import cytodisk as cd
from cytodisk.errors import ParameterError, ReadError, StudyError
from cytodisk.io.correlation_store import list_correlations, write_correlation
from cytodisk.simulate import movie
from cytodisk.study.correlate import correlate_study
from cytodisk.study.movie_inputs import open_movie
from cytodisk.study.movie_run import run_movie
from cytodisk.study.parameters import MovieParameters

SMALL = MovieParameters(layers=4, sectors=12)
FEW = {"surrogates": 49}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    folder = tmp_path_factory.mktemp("correlate")
    truth = movie("fluctuating", 3, frames=36, radius_px=22, dropped=0.06, lag_frames=2)
    masks, signal = write_movie(folder, truth)
    return run_movie(open_movie(masks, signal, SMALL), folder / "out")


def test_tables_are_those_of_the_functions(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=6, **FEW)
    activity = study.activity(0)
    expected = cd.cross_correlate(
        activity["mean"].sel(channel="edge"), activity["velocity"], 6, surrogates=49
    )
    peak = cd.peak_correlation(expected)
    windows = found.windows.set_index(["layer", "sector"])
    for name in ("correlation", "lag", "lag_s", "n", "n_effective", "low", "high", "p", "q"):
        table = windows[name].unstack("sector").to_numpy()
        np.testing.assert_array_equal(table, peak[name].transpose("layer", "sector").to_numpy(), name)
    curves = found.curves.set_index(["layer", "sector", "lag"])["correlation"].to_xarray()
    np.testing.assert_array_equal(curves, expected["correlation"].transpose(*curves.dims))
    mean = cd.correlation_by_layer(expected)
    layers = found.layer_curves.set_index(["layer", "lag"])
    for name in ("correlation", "lower_quartile", "upper_quartile"):
        np.testing.assert_array_equal(layers[name].to_xarray(), mean[name].transpose("layer", "lag"))
    np.testing.assert_array_equal(found.layers["threshold"], mean["threshold"])
    assert found.windows.attrs["units"]["lag_s"] == "s"
    np.testing.assert_allclose(found.windows["lag_s"], 5.0 * found.windows["lag"])


def test_the_lag_that_was_simulated_is_found(study: cd.Study) -> None:
    found = correlate_study(study, "edge", **FEW)
    assert found.settings["max_lag"] == 9  # a quarter of the frames
    outer = found.layers.set_index("layer").loc[0]
    assert outer["lag"] == -2
    assert outer["correlation"] > 0.8
    assert outer["q"] < 0.05


def test_it_can_be_read_again_and_is_replaced(study: cd.Study) -> None:
    first = correlate_study(study, "edge", max_lag=4, **FEW)
    again = cd.open_study(study.path).correlation("edge", "velocity")
    pd.testing.assert_frame_equal(again.windows, first.windows)
    assert ("edge", "velocity") in study.correlations
    assert correlate_study(study, "edge", max_lag=5, **FEW).settings["max_lag"] == 5
    assert study.correlation("edge").settings["max_lag"] == 5
    assert not list(first.path.parent.glob(".*"))


def test_the_same_seed_gives_the_same_bytes(study: cd.Study) -> None:
    def content() -> dict[str, bytes]:
        path = correlate_study(study, "edge", max_lag=5, **FEW).path
        return {file.name: file.read_bytes() for file in path.iterdir()}

    assert content() == content()


def test_two_signals_and_their_pairs(study: cd.Study) -> None:
    found = correlate_study(study, "material", "edge", max_lag=3, pairs=True, surrogates=9)
    pairs = found.pairs
    assert pairs is not None
    assert set(pairs["along"]) == {"straight", "interior", "edge"}
    assert pairs.attrs["units"]["distance"] == "µm"
    n = pairs.groupby(["along", "lag"])["n"].sum()
    assert (n == 48 * 48).all()
    assert found.events is None


def test_a_signal_against_the_edge_of_its_sector(study: cd.Study) -> None:
    found = correlate_study(study, "edge", "edge", against="edge", max_lag=3, surrogates=0)
    outer = found.windows[found.windows["layer"] == 0]
    np.testing.assert_allclose(outer["correlation"], 1.0)
    assert (outer["lag"] == 0).all()
    assert "q" not in found.windows


def test_episodes_and_averages_stand_beside(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=5, **FEW)
    assert found.events is not None
    assert set(found.events["kind"]) == {"protrusion", "retraction"}
    assert found.events.attrs["units"]["area"] == "µm²"
    averages = found.event_averages
    assert averages is not None
    assert set(averages["delay"]) == set(range(-5, 6))
    outer = averages[(averages["layer"] == 0) & (averages["kind"] == "protrusion")].set_index("delay")["mean"]
    assert outer.idxmax() >= 2  # the signal follows the edge by two frames


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ({"signal": "VASP"}, "signal 'VASP' is not in the study: it has 'material', 'edge'"),
        ({"with_": "speed"}, "with 'speed' is not in the study: it has velocity, velocity_cell_frame"),
        ({"with_": "edge"}, "with itself in the same window is 1"),
        ({"pairs": True}, "pairs need two signals"),
        ({"max_lag": 40}, "max_lag 40 leaves 0 pairs of 36 frames"),
        ({"cells": [2]}, "has no cell 2"),
        ({"rule": "best"}, "rule must be one of nearest, largest, got 'best'"),
        ({"null": "shuffle"}, "null must be one of phase, shift, got 'shuffle'"),
        ({"surrogates": -1}, "surrogates must be a whole number of at least 0, got -1"),
        ({"lag": 3}, "settings have no 'lag'"),
        ({"detrend": "spline"}, "detrend must be one of none, linear, median, got 'spline'"),
    ],
)
def test_what_cannot_be_correlated_is_refused(study: cd.Study, call: dict, message: str) -> None:
    before = list_correlations(study.path)
    with pytest.raises(ParameterError, match=message):
        correlate_study(study, **({"signal": "edge", "surrogates": 9} | call))
    assert list_correlations(study.path) == before


def test_a_correlation_that_is_not_there_lists_those_that_are(study: cd.Study) -> None:
    correlate_study(study, "edge", max_lag=3, surrogates=0)
    with pytest.raises(ReadError, match=r"no correlation of 'edge' with 'nothing': .*edge with vel"):
        study.correlation("edge", "nothing")


def test_a_study_without_a_signal(tmp_path: Path) -> None:
    truth = movie("bulging", 0, frames=12, radius_px=14, signals=False)
    masks = write_masks(tmp_path / "masks.tif", truth.masks.astype(np.uint8))
    bare = run_movie(open_movie(masks, None, SMALL), tmp_path / "out")
    with pytest.raises(StudyError, match="has no signal: run cytodisk movie with --signal"):
        correlate_study(bare, "edge")


def test_short_cells_have_a_row_with_the_reason(tmp_path: Path) -> None:
    """Two cells as labels, of which one is there for a few frames only."""
    truth = movie("fluctuating", 0, frames=30, radius_px=16)
    assert truth.signal is not None
    labels = np.concatenate([truth.masks, 2 * truth.masks.astype(np.uint8)], axis=2).astype(np.uint8)
    labels[8:][labels[8:] == 2] = 0
    truth = type(truth)(**(vars(truth) | {"masks": labels, "signal": _twice(truth.signal)}))
    masks, signal = write_movie(tmp_path, truth)
    study = run_movie(open_movie(masks, signal, SMALL), tmp_path / "out")
    found = correlate_study(study, "edge", max_lag=5, surrogates=9)
    cells = found.cells.set_index("cell")
    assert cells["status"].tolist() == ["ok", "refused"]
    assert "fewer than min_pairs 10" in cells.loc[1, "reason"]
    assert set(found.windows["cell"]) == {0}
    with pytest.raises(ParameterError, match=r"no cell of .* can be correlated: max_lag 5 leaves"):
        correlate_study(study, "edge", max_lag=5, cells=[1])


def test_names_that_no_file_can_have(tmp_path: Path) -> None:
    table = pd.DataFrame({"cell": [0]})
    for signal, with_ in (("a/b", "velocity"), ("a_b", "velocity"), ("β~γ", "../x"), ("β", "γ~../x")):
        found = write_correlation(tmp_path, signal, with_, {"windows": table}, {})
        assert found.path.parent == tmp_path / "correlation"
        assert (found.signal, found.with_) == (signal, with_)
    assert len(list_correlations(tmp_path)) == 4


def test_a_damaged_correlation_says_so(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=3, surrogates=0)
    (found.path / "windows.parquet").unlink()
    with pytest.raises(ReadError, match="is damaged, correlate again"):
        _ = study.correlation("edge").windows
    (found.path / "settings.json").write_text("{", encoding="utf-8")
    with pytest.raises(ReadError, match="no correlation of 'edge'"):
        study.correlation("edge")
    assert json.loads((correlate_study(study, "edge", surrogates=0).path / "settings.json").read_text())


def _twice(signal: object) -> object:
    import xarray as xr

    assert isinstance(signal, xr.DataArray)
    return xr.concat([signal, signal], dim="x")
