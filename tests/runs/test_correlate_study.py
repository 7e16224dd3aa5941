"""Correlating a study: the tables hold what the functions give, whatever its cells are like."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from movie_files import write_masks, write_movie

import cytodisk as cd
from cytodisk.errors import ParameterError, ReadError, StudyError
from cytodisk.files import is_temporary
from cytodisk.runs.correlate.cluster_rows import ranges_in_words
from cytodisk.runs.correlate.correlate_study import correlate_study
from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.simulate import movie
from cytodisk.store.correlation_store import correlation_path, list_correlations, write_correlation

SMALL = MovieParameters(layers=4, sectors=12)
FEW = {"surrogates": 49}
PLAIN: dict = {"surrogates": 0, "geometry": False}  # where it matters that there is a correlation alone


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    folder = tmp_path_factory.mktemp("correlate")
    truth = movie("fluctuating", 3, frames=36, radius_px=22, dropped=0.06, lag_frames=2)
    masks, signal = write_movie(folder, truth)
    return movie_study(open_movie(masks, signal, SMALL), folder / "out")


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


def test_ranks_are_labelled(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=6, statistic="spearman", name="ranks", surrogates=19)
    activity = study.activity(0)
    expected = cd.cross_correlate(
        activity["mean"].sel(channel="edge"), activity["velocity"], 6, statistic="spearman"
    )
    curves = found.curves.set_index(["layer", "sector", "lag"])["correlation"].to_xarray()
    np.testing.assert_array_equal(curves, expected["correlation"].transpose(*curves.dims))
    assert found.settings["statistic"] == "spearman"
    assert found.cells["statistic"].tolist() == ["spearman"]


def test_clusters_are_those_of_the_function_with_their_places_in_words(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=6, **FEW)
    activity = study.activity(0)
    correlations = cd.cross_correlate(
        activity["mean"].sel(channel="edge"), activity["velocity"], 6, clusters=True, **FEW
    )
    expected = cd.correlation_clusters(correlations)
    clusters = found.clusters
    assert clusters is not None
    assert len(clusters) == expected.sizes["cluster"] > 0
    for name in ("cluster", "lag", "sign", "correlation", "mass", "p"):
        np.testing.assert_array_equal(clusters[name], expected[name], name)
    first = clusters.iloc[0]
    assert (first["lag"], first["sign"], first["lag_s"]) == (-2, 1, -10.0)
    assert first["layers"].startswith("0")
    numbers = found.windows.set_index(["layer", "sector"])["cluster"].to_xarray()
    member = expected["member"].isel(cluster=0).to_numpy()
    np.testing.assert_array_equal((numbers == 1).transpose("layer", "sector").to_numpy(), member)
    assert found.cells["cluster_surrogates"].tolist() == [FEW["surrogates"]]
    assert clusters.attrs["units"]["lag_s"] == "s"


def test_clusters_can_be_left_out_or_be_none(study: cd.Study) -> None:
    for options in ({"clusters": False, "surrogates": 19, "geometry": False}, PLAIN):
        found = correlate_study(study, "edge", max_lag=3, name="plain", **options)
        assert found.clusters is None
        assert "cluster" not in found.windows
        assert found.cells["cluster_surrogates"].tolist() == [0]
    none = correlate_study(
        study, "material", max_lag=3, name="none", surrogates=19, sectors=(2, 3), geometry=False
    ).clusters
    assert none is not None
    assert list(none.columns)[:2] == ["cell", "cluster"]


@pytest.mark.parametrize(
    ("numbers", "count", "words"),
    [
        ([0, 1, 2], None, "0–2"),
        ([3, 1, 7, 8], None, "1, 3, 7–8"),
        ([58, 59, 0, 1], 60, "58–1"),
        ([59, 0, 4, 5, 30], 60, "4–5, 30, 59–0"),
        ([0, 1, 2, 3], 4, "0–3"),
        ([5, 6], 60, "5–6"),
        ([], 60, ""),
    ],
)
def test_places_in_words(numbers: list[int], count: int | None, words: str) -> None:
    assert ranges_in_words(numbers, count) == words


def test_every_column_is_explained(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=6, **FEW)
    signals = correlate_study(study, "edge", "material", max_lag=6, pairs=True, **FEW)
    assert signals.pairs is not None
    tables = {"pairs": signals.pairs} | {
        name: getattr(found, name) for name in CORRELATION_TABLES if name != "pairs"
    }
    for name, columns in CORRELATION_TABLES.items():
        assert set(tables[name].columns) == {column.name for column in columns}, name
    told = pd.read_csv(found.path / "columns.csv", keep_default_na=False)
    for name in set(CORRELATION_TABLES) - {"pairs"}:
        rows = told[told["table"] == f"{name}.parquet"].set_index("column")
        assert set(rows.index) == set(tables[name].columns)
        units = tables[name].attrs["units"]  # without them in "cells"
        assert all(unit in ("", rows.loc[column, "unit"]) for column, unit in units.items())


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
    assert correlate_study(study, "edge", max_lag=5, **PLAIN).settings["max_lag"] == 5
    assert study.correlation("edge").settings["max_lag"] == 5
    assert not list(first.path.parent.glob(".*"))


def test_the_same_seed_gives_the_same_bytes(study: cd.Study) -> None:
    def content() -> dict[str, bytes]:
        path = correlate_study(study, "edge", max_lag=5, **FEW).path
        return {file.name: file.read_bytes() for file in path.iterdir()}

    assert content() == content()


def test_two_signals_and_their_pairs(study: cd.Study) -> None:
    found = correlate_study(study, "material", "edge", max_lag=3, pairs=True, surrogates=19)
    pairs = found.pairs
    assert pairs is not None
    assert set(pairs["along"]) == {"straight", "interior", "edge"}
    assert pairs.attrs["units"]["distance"] == "µm"
    n = pairs.groupby(["along", "lag"])["n"].sum()
    assert (n == 48 * 48).all()
    assert found.events is None


def test_a_signal_against_the_edge_of_its_sector(study: cd.Study) -> None:
    found = correlate_study(study, "edge", "edge", against="edge", max_lag=3, **PLAIN)
    outer = found.windows[found.windows["layer"] == 0]
    np.testing.assert_allclose(outer["correlation"], 1.0)
    assert (outer["lag"] == 0).all()
    assert "q" not in found.windows


def test_events_and_averages_stand_beside(study: cd.Study) -> None:
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
        ({"surrogates": -1}, "surrogates must be a whole number from 0 to 100000, got -1"),
        ({"lag": 3}, "no parameter 'lag'"),
        ({"detrend": "spline"}, "detrend must be one of none, linear, median, got 'spline'"),
    ],
)
def test_what_cannot_be_correlated_is_refused(study: cd.Study, call: dict, message: str) -> None:
    before = list_correlations(study.path)
    with pytest.raises(ParameterError, match=message):
        correlate_study(study, **({"signal": "edge", "surrogates": 19} | call))
    assert list_correlations(study.path) == before


def test_a_correlation_that_is_not_there_lists_those_that_are(study: cd.Study) -> None:
    correlate_study(study, "edge", max_lag=3, **PLAIN)
    with pytest.raises(ReadError, match=r"edge with nothing.*edge with vel"):
        study.correlation("edge", "nothing")


def test_a_study_without_a_signal(tmp_path: Path) -> None:
    truth = movie("bulging", 0, frames=12, radius_px=14, signals=False)
    masks = write_masks(tmp_path / "masks.tif", truth.masks.astype(np.uint8))
    bare = movie_study(open_movie(masks, None, SMALL), tmp_path / "out")
    with pytest.raises(StudyError, match=r"no signal.*--signal"):
        correlate_study(bare, "edge")


def test_short_cells_have_a_row_with_the_reason(tmp_path: Path) -> None:
    """Two cells as labels, of which one is there for a few frames only."""
    truth = movie("fluctuating", 0, frames=30, radius_px=16)
    assert truth.signal is not None
    labels = np.concatenate([truth.masks, 2 * truth.masks.astype(np.uint8)], axis=2).astype(np.uint8)
    labels[8:][labels[8:] == 2] = 0
    truth = type(truth)(**(vars(truth) | {"masks": labels, "signal": _twice(truth.signal)}))
    masks, signal = write_movie(tmp_path, truth)
    study = movie_study(open_movie(masks, signal, SMALL), tmp_path / "out")
    found = correlate_study(study, "edge", max_lag=5, surrogates=19)
    cells = found.cells.set_index("cell")
    assert cells["status"].tolist() == ["ok", "refused"]
    assert "fewer than min_pairs 10" in cells.loc[1, "reason"]
    assert set(found.windows["cell"]) == {0}
    with pytest.raises(ParameterError, match=r"no cell.*max_lag 5"):
        correlate_study(study, "edge", max_lag=5, cells=[1])


def test_names_that_no_file_can_have(tmp_path: Path) -> None:
    table = pd.DataFrame({"cell": [0]})
    for signal, with_ in (("a/b", "velocity"), ("a_b", "velocity"), ("β~γ", "../x"), ("β", "γ~../x")):
        found = write_correlation(tmp_path, signal, with_, {"windows": table}, CORRELATION_TABLES, {})
        assert found.path.parent == tmp_path / "correlation"
        assert (found.signal, found.with_) == (signal, with_)
    assert len(list_correlations(tmp_path)) == 4


def test_a_damaged_correlation_says_so(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=3, **PLAIN)
    (found.path / "windows.parquet").unlink()
    with pytest.raises(ReadError, match="run cytodisk correlate again"):
        _ = study.correlation("edge").windows
    (found.path / "settings.json").write_text("{", encoding="utf-8")
    with pytest.raises(ReadError, match="settings\\.json is not the settings of a correlation"):
        study.correlation("edge")
    assert json.loads((correlate_study(study, "edge", **PLAIN).path / "settings.json").read_text())


def _twice(signal: object) -> object:
    import xarray as xr

    assert isinstance(signal, xr.DataArray)
    return xr.concat([signal, signal], dim="x")


def test_some_frames_and_sectors(study: cd.Study) -> None:
    """What is left out is as if it were not there: the same as correlating the rest by hand."""
    settings = {"max_lag": 3, "frames": (4, 30), "without_frames": (12,), "sectors": (10, 2), **FEW}
    found = correlate_study(study, "edge", name="part", **settings)
    assert sorted(found.windows["sector"].unique()) == [0, 1, 2, 10, 11]
    activity = study.activity(0).load()
    signal = activity["mean"].sel(channel="edge", sector=[0, 1, 2, 10, 11], frame=slice(4, 30)).copy()
    velocity = activity["velocity"].sel(sector=[0, 1, 2, 10, 11], frame=slice(4, 30)).copy()
    signal.loc[{"frame": 12}] = np.nan
    velocity.loc[{"frame": [11, 12, 30]}] = np.nan
    expected = cd.peak_correlation(cd.cross_correlate(signal, velocity, 3, surrogates=49))
    table = found.windows.set_index(["layer", "sector"])["correlation"].unstack("sector").to_numpy()
    np.testing.assert_array_equal(table, expected["correlation"].transpose("layer", "sector"))
    assert found.settings["sectors"] == [10, 2]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"frames": (90, 99)}, "frames 90:99 are not in the movie: it has 0:35"),
        ({"frames": (0, 36)}, "frames 0:36 are not in the movie: it has 0:35"),
        ({"frames": (20, 10)}, "frames must go from the first to the last"),
        ({"without_frames": (3, 77)}, "without_frames has 77: the movie has 0:35"),
        ({"sectors": (0, 12)}, "sectors 0:12 are not on the edge: it has 0:11"),
        ({"sectors": (5, 4)}, "sectors 5:4 are the whole edge, or two swapped"),
        ({"sectors": (3,)}, "sectors must be the first and the last"),
        ({"sectors": (1.5, 7)}, "sectors must be the first and the last, .*got 1.5"),
        ({"without_frames": 17}, "without_frames must be whole numbers"),
        ({"name": 5}, "name must be a text, got 5"),
        ({"name": "n" * 300}, "name must be a text of at most 60 letters"),
        ({"surrogates": 5}, "surrogates must be 0, or at least 19"),
        ({"max_lag": "x"}, "max_lag must be a whole number from 0 to 1000000, got 'x'"),
    ],
)
def test_parts_that_are_not_there(study: cd.Study, settings: dict, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        correlate_study(study, "edge", **settings)


def test_variants_stand_beside_each_other(study: cd.Study) -> None:
    correlate_study(study, "edge", max_lag=3, **PLAIN)
    correlate_study(study, "edge", max_lag=4, **PLAIN, detrend="linear", name="linear")
    assert ("edge", "velocity", "linear") in study.correlations
    assert ("edge", "velocity") in study.correlations
    assert study.correlation("edge").settings["max_lag"] == 3
    assert study.correlation("edge", "velocity", "linear").settings["detrend"] == "linear"


def test_a_crash_while_replacing_loses_nothing(study: cd.Study, monkeypatch: pytest.MonkeyPatch) -> None:
    before = correlate_study(study, "edge", max_lag=3, **PLAIN).windows

    def no_room(*_: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("cytodisk.store.derived.derived_folder.write_table", no_room)
        with pytest.raises(StudyError, match="No space left on device"):
            correlate_study(study, "edge", max_lag=4, **PLAIN)
    pd.testing.assert_frame_equal(study.correlation("edge").windows, before)
    assert not list((study.path / "correlation").glob(".*"))


def test_a_cut_off_table_says_so(study: cd.Study) -> None:
    found = correlate_study(study, "edge", max_lag=3, **PLAIN)
    table = found.path / "layers.parquet"
    table.write_bytes(table.read_bytes()[:100])
    with pytest.raises(ReadError, match="run cytodisk correlate again"):
        _ = study.correlation("edge").layers
    correlate_study(study, "edge", max_lag=3, **PLAIN)


def test_jitter_is_looked_for_whatever_the_lags(study: cd.Study) -> None:
    assert correlate_study(study, "edge", max_lag=2, **PLAIN).cells["jitter"].notna().all()
    short = correlate_study(study, "edge", max_lag=2, **PLAIN, frames=(0, 13), name="short")
    assert short.cells["jitter"].isna().all()  # fewer than six lags
    assert correlate_study(study, "edge", **PLAIN, skip_lags=(-1, 0)).cells["jitter"].item() == 0.0


def test_numbers_of_numpy_are_numbers(study: cd.Study) -> None:
    found = correlate_study(
        study,
        "edge",
        cells=list(study.cells["cell"].unique()),
        max_lag=np.int64(3),
        frames=(np.int64(0), np.int64(30)),
        skip_lags=np.array([-1, 0]),
        surrogates=0,
        name="numpy",
    )
    assert found.settings["skip_lags"] == [-1, 0]
    assert found.settings["cells"] == [0]


def test_a_folder_that_cannot_be_exchanged_stays(study: cd.Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither a failure between the two renames nor a kill there loses the old result."""
    found = correlate_study(study, "edge", max_lag=3, **PLAIN)
    before, rename = found.windows, Path.replace

    def fail(self: Path, target: Path) -> Path:
        if is_temporary(self.name) and not target.suffix:
            raise OSError(28, "No space left on device")
        return rename(self, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", fail)
        with pytest.raises(StudyError, match="No space left on device"):
            correlate_study(study, "edge", max_lag=4, **PLAIN)
    pd.testing.assert_frame_equal(study.correlation("edge").windows, before)
    found.path.replace(found.path.with_name(f".old~{found.path.name}"))  # as a kill leaves it
    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", fail)
        with pytest.raises(StudyError, match="No space left on device"):
            correlate_study(study, "edge", max_lag=4, **PLAIN)
    pd.testing.assert_frame_equal(study.correlation("edge").windows, before)


def test_events_of_some_sectors_are_those_of_the_whole_edge(study: cd.Study) -> None:
    whole = correlate_study(study, "edge", max_lag=3, **PLAIN).events
    part = correlate_study(study, "edge", max_lag=3, **PLAIN, sectors=(10, 2), name="part").events
    assert whole is not None
    assert part is not None
    expected = whole[whole["sector"].isin([10, 11, 0, 1, 2])].reset_index(drop=True)
    pd.testing.assert_frame_equal(part, expected)


def test_the_number_of_surrogates_is_that_which_was_made(study: cd.Study) -> None:
    shifted = correlate_study(study, "edge", max_lag=2, null="shift", surrogates=99, name="shift")
    assert shifted.settings["surrogates_made"] == shifted.cells["surrogates"].item() < 7


def test_the_usual_lag_leaves_enough_pairs_of_frames(study: cd.Study) -> None:
    frames = study.activity(0).sizes["time"]
    found = correlate_study(study, "edge", name="short", min_pairs=frames - 2, **FEW)
    assert found.settings["max_lag"] == 2


def test_a_link_in_the_place_of_a_correlation_is_refused(tmp_path: Path) -> None:
    behind = tmp_path / "mine"
    behind.mkdir()
    (behind / "notes.txt").write_text("mine")
    link = correlation_path(tmp_path, "edge", "velocity")
    link.parent.mkdir()
    link.symlink_to(behind)
    with pytest.raises(StudyError, match=r"it is a link to .*mine; remove the link"):
        write_correlation(tmp_path, "edge", "velocity", {}, {}, {})
    assert link.is_symlink()
    assert (behind / "notes.txt").read_text() == "mine"
    assert [path.name for path in link.parent.iterdir()] == [link.name]
