"""Predictions of a study: tables, directions, what is given, cells that are left out, refusals."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.runs.predict.predict_study import predict_study
from cytodisk.store.predictions.prediction_store import Prediction
from made_study import MadeStudy, made_activity, made_study, predicting_activity

FEW: Any = {"max_order": 3, "surrogates": 59, "geometry": False}


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> MadeStudy:
    """Two cells in which Rac1 in layer 0 predicts velocity, and a third of too few frames."""
    made = {cell: predicting_activity(cell, strength=0.5) for cell in (0, 1)}
    made[2] = predicting_activity(2, frames=4)
    return made_study(tmp_path_factory.mktemp("predict") / "out", made)


@pytest.fixture(scope="module")
def pair(study: MadeStudy) -> Prediction:
    return predict_study(study, "Rac1", "velocity", **FEW, csv=True)


def of(table: pd.DataFrame, source: str, target: str) -> pd.DataFrame:
    return table[(table["source"] == source) & (table["target"] == target)]


def test_both_directions_are_tested_and_the_true_one_is_found(pair: Prediction) -> None:
    links = pair.links
    assert links.groupby(["cell", "source", "target"]).size().tolist() == [2] * 4
    there = of(links, "Rac1", "velocity")
    assert (there.loc[there["layer"] == 0, "q"] < 0.05).all()
    assert (there.loc[there["layer"] == 0, "effect"] > 0).all()
    assert (of(links, "velocity", "Rac1")["q"] > 0.05).all()
    assert (links["status"] == "ok").all()
    assert links.attrs["units"]["gain"] == "nat"
    assert links["gain_partial"].isna().all()  # geometry was not to be tested


def test_values_are_those_of_predict(study: MadeStudy, pair: Prediction) -> None:
    activity = study.activity(1)
    source = activity["mean"].sel(channel="Rac1", drop=True)
    found = cd.predict(source, activity["velocity"], max_order=3, surrogates=59)
    rows = of(pair.links[pair.links["cell"] == 1], "Rac1", "velocity")
    for name in ("gain", "gain_excess", "likelihood_ratio", "effect", "p", "threshold", "n", "source_order"):
        np.testing.assert_allclose(rows[name], found[name], err_msg=name)
    lags = of(pair.lags[(pair.lags["cell"] == 1) & (pair.lags["layer"] == 0)], "Rac1", "velocity")
    known = found["coefficient"].sel(layer=0).dropna("lag")
    scale = found["effect"].sel(layer=0) / known.sum()  # to series of standard deviation 1
    np.testing.assert_allclose(lags["coefficient"], known * scale)
    assert lags["coefficient"].sum() == pytest.approx(rows["effect"].iloc[0])
    assert lags["lag_s"].tolist() == (5.0 * known["lag"]).to_numpy().tolist()
    assert (lags["low"] < lags["coefficient"]).all()


def test_a_cleaner_copy_of_the_past_does_not_count(tmp_path: Path) -> None:
    """The signal follows velocity, which is measured with noise: so it predicts velocity a little."""
    random = np.random.default_rng(0)
    true = np.zeros((300, 8))
    for frame in range(1, 300):
        true[frame] = 0.9 * true[frame - 1] + random.normal(size=8)
    signal = np.roll(true, 1, axis=0) + 0.1 * random.normal(size=true.shape)
    velocity = true + 1.5 * random.normal(size=true.shape)
    made = made_activity({"Rac1": signal[:, None]}, velocity)
    found = predict_study(made_study(tmp_path / "out", {0: made}), "Rac1", "velocity", **FEW)
    there, back = found.links.to_dict("records")
    assert there["q"] < 0.05
    assert there["weaker"]
    assert there["gain_reversed"] > 2 * there["gain"]
    assert not back["weaker"]
    assert "weaker direction" in found.cells["qc_flags"].item()


def test_q_is_over_all_rows_of_the_cell(pair: Prediction) -> None:
    for _, rows in pair.links.groupby("cell"):
        ordered = rows.sort_values("p")
        least = (ordered["p"] * len(rows) / np.arange(1, len(rows) + 1)).min()
        assert rows["q"].min() == pytest.approx(min(least, 1.0))


def test_cells_are_pooled_and_those_left_out_have_a_row(pair: Prediction) -> None:
    cells = pair.cells.set_index("cell")
    assert cells["status"].tolist() == ["ok", "ok", "refused"]
    assert "4 frames" in cells.loc[2, "reason"]
    assert "not predicted" in cells.loc[2, "qc_flags"]
    assert "common driver" in cells.loc[0, "qc_flags"]  # RhoA was not given
    assert cells.loc[0, "not_given"] == "RhoA"
    pooled = pair.pooled
    assert (pooled["cells"] == 2).all()
    links = of(pair.links[pair.links["layer"] == 0], "Rac1", "velocity")
    one = of(pooled[pooled["layer"] == 0], "Rac1", "velocity").iloc[0]
    weights = links["n"] / links["n"].sum()
    assert one["gain"] == pytest.approx((weights * links["gain"]).sum())
    assert one["gain_excess"] == pytest.approx((weights * links["gain_excess"]).sum())
    assert one["p"] == pytest.approx(1 / 60)
    assert of(pooled, "velocity", "Rac1")["p"].min() > 0.05
    assert not pooled["weaker"].any()
    means = pair.links.groupby(["source", "layer"])["gain_reversed"].agg(["min", "max"])
    by_link = pooled.set_index(["source", "layer"])["gain_reversed"]
    assert by_link.between(means["min"].loc[by_link.index], means["max"].loc[by_link.index]).all()


def test_files_settings_and_the_open_study(study: MadeStudy, pair: Prediction) -> None:
    assert pair.path == study.path / "prediction" / "Rac1~velocity"
    assert {file.name for file in pair.path.iterdir()} == {
        *(f"{name}.{kind}" for name in ("links", "lags", "pooled", "cells") for kind in ("parquet", "csv")),
        "columns.csv",
        "settings.json",
    }
    settings = json.loads((pair.path / "settings.json").read_text(encoding="utf-8"))
    assert settings["signals"] == ["Rac1", "velocity"]
    assert settings["asked"] == {"max_order": 3, "surrogates": 59, "geometry": False}
    assert ("Rac1", "velocity") in study.predictions
    pd.testing.assert_frame_equal(study.prediction("Rac1", "velocity").links, pair.links)


def test_a_network_gives_all_others(study: MadeStudy) -> None:
    found = predict_study(study, cells=[0], **FEW | {"surrogates": 299})
    assert found.path.name == "network"
    assert found.signals == ("Rac1", "RhoA", "velocity")
    given = found.links.groupby(["source", "target"])["given"].unique().str.join("+").to_dict()
    assert given["Rac1", "velocity"] == "RhoA"
    assert given["RhoA", "Rac1"] == "velocity"
    assert len(given) == 6
    significant = found.links[found.links["q"] < 0.05]
    assert set(zip(significant["source"], significant["target"], strict=True)) == {("Rac1", "velocity")}
    assert 0 in significant["layer"].tolist()


def test_the_sectors_that_are_used_are_no_ring(study: MadeStudy) -> None:
    """The last of them is no neighbour of the first: both ends have but one."""
    part = predict_study(study, "Rac1", "velocity", cells=[0], sectors=(1, 5), name="part", **FEW)
    activity = study.activity(0).isel(sector=slice(1, 6))
    source = activity["mean"].sel(channel="Rac1", drop=True)
    how: Any = {"max_order": 3, "surrogates": 59, "edge_sectors": 8}
    found = cd.predict(source, activity["velocity"], **how)
    np.testing.assert_allclose(of(part.links, "Rac1", "velocity")["gain"], found["gain"])


def test_frames_that_are_left_out_break_the_past(study: MadeStudy) -> None:
    cut = predict_study(study, "Rac1", "velocity", cells=[0], without_frames=(50,), name="cut", **FEW)
    whole = predict_study(study, "Rac1", "velocity", cells=[0], name="whole", **FEW)
    assert cut.cells["gaps"].item() == 2  # no step of the edge leads to it
    assert whole.cells["gaps"].item() == 0
    assert (cut.links["n"] < whole.links["n"]).all()


def test_a_constant_layer_has_a_row_that_says_so(tmp_path: Path) -> None:
    activity = predicting_activity(3)
    activity["mean"][:, 0, 1] = 7.0
    found = predict_study(made_study(tmp_path / "out", {0: activity}), "Rac1", "velocity", **FEW)
    still = found.links[found.links["layer"] == 1]
    assert (still["status"] == "refused").all()
    assert still["reason"].str.contains("constant").all()
    assert still["n"].isna().all()
    assert (found.links.loc[found.links["layer"] == 0, "status"] == "ok").all()


def test_one_sector_is_enough(tmp_path: Path) -> None:
    activity = predicting_activity(4, frames=150, sectors=1, strength=0.6)
    found = predict_study(made_study(tmp_path / "out", {0: activity}), "Rac1", "velocity", **FEW)
    assert found.links["gain"].notna().all()


@pytest.mark.parametrize(
    ("names", "settings", "words"),
    [
        (("Rac", "velocity"), {}, "source 'Rac' is not in the study: it has velocity"),
        (("Rac1", "speed"), {}, "target 'speed' is not in the study"),
        (("Rac1", None), {}, "target is not given, only 'Rac1': pass both"),
        (("Rac1", "Rac1"), {}, "source and target are both 'Rac1'"),
        (("velocity", "velocity_cell_frame"), {}, "are both velocities"),
        (("Rac1", "velocity"), {"given": ("Rac1",)}, "given 'Rac1' is source or target"),
        (("Rac1", "velocity"), {"given": ("X",)}, "given 'X' is not in the study"),
        (("Rac1", "velocity"), {"given": ("RhoA", "RhoA")}, "given names 'RhoA' twice"),
        (("Rac1", "velocity"), {"surrogates": 5}, "surrogates must be 0, or at least 19"),
        (("Rac1", "velocity"), {"frames": (0, 500)}, "frames 0:500 are not in the movie"),
        (("Rac1", "velocity"), {"cells": [2]}, "no cell of .* can be tested: .*4 frames"),
        (("Rac1", "velocity"), {"cells": [9]}, "has no cell 9"),
    ],
)
def test_what_cannot_be_tested_is_refused(
    study: MadeStudy, names: Any, settings: dict[str, Any], words: str
) -> None:
    with pytest.raises(ParameterError, match=words):
        predict_study(study, *names, **FEW | settings)


def test_a_channel_called_velocity_is_refused(tmp_path: Path) -> None:
    activity = predicting_activity(5, frames=20)
    named = made_activity({"velocity": activity["mean"].to_numpy()[:, 0]}, activity["velocity"].to_numpy())
    with pytest.raises(ParameterError, match="has a channel called 'velocity'"):
        predict_study(made_study(tmp_path / "out", {0: named}), **FEW)
