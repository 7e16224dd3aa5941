from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.cli import app
from cytodisk.errors import ParameterError, PopulationError, ReadError
from cytodisk.pages.batch_reports import write_batch_reports
from cytodisk.runs.population.correlations.run_batch_correlate import only_channel, run_batch_correlate
from cytodisk.store.populations.pooled_correlation import PooledCorrelation, open_pooled_correlation

pytestmark = pytest.mark.slow  # a process for each movie

LAG = 2
HEAD = """
[study]
kind = "movie"

[parameters]
layers = 2
sectors = 8
frame_interval_s = 5.0
"""
SETTINGS = {"surrogates": 0, "geometry": False, "clusters": False}


def write_movie(folder: Path, name: str, seed: int, frames: int = 40) -> None:
    truth = cd.simulate.movie("fluctuating", frames=frames, radius_px=14, seed=seed, lag_frames=LAG)
    tifffile.imwrite(folder / f"{name}_masks.tif", truth.masks.astype("uint8"), photometric="minisblack")
    metadata = {"axes": "TCYX", "Channel": {"Name": ["follower", "other"]}}
    tifffile.imwrite(folder / f"{name}_signal.ome.tif", truth.signal.to_numpy(), metadata=metadata)


def entry(name: str, experiment: str) -> str:
    files = f'masks = "{name}_masks.tif"\nsignal = "{name}_signal.ome.tif"'
    group = f'condition = "control"\nexperiment = "{experiment}"'
    return f'\n[[inputs]]\nname = "{name}"\n{files}\n{group}\n'


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("movies")
    for seed in range(2):
        write_movie(folder, f"m{seed}", seed)
    write_movie(folder, "short", 7, frames=8)
    tifffile.imwrite(folder / "image.tif", cd.simulate.disk(12).astype("uint8"))
    return folder


@pytest.fixture(scope="module")
def batch(files: Path) -> Path:
    entries = [entry(f"m{seed}", f"day {seed}") for seed in range(2)]
    image = '\n[[inputs]]\nname = "image"\nkind = "map"\nmasks = "image.tif"\n'
    (files / "batch.toml").write_text(HEAD + "".join([*entries, entry("short", "day 1")]) + image)
    cd.run_batch(files / "batch.toml", files / "out", workers=2)
    return files / "out"


@pytest.fixture(scope="module")
def pooled(batch: Path) -> PooledCorrelation:
    return run_batch_correlate(batch, "follower", max_lag=6, csv=True, **SETTINGS)


def test_every_movie_counts_or_has_a_row_that_says_why(pooled: PooledCorrelation) -> None:
    studies = pooled.studies.set_index("input")
    assert studies["status"].to_dict() == {
        "m0": "ok",
        "m1": "ok",
        "short": "refused",
        "image": "left out",
    }
    assert studies.loc["image", "reason"] == "no movie: nothing in it changes with time"
    assert "frames" in studies.loc["short", "reason"]
    assert studies["cells"].sum() == 2


def test_tables_hold_what_the_movies_hold(batch: Path, pooled: PooledCorrelation) -> None:
    for name in ("m0", "m1"):
        own = cd.open_study(batch / "inputs" / name).correlation("follower").layer_curves
        curve = pooled.curves[pooled.curves["input"] == name]
        np.testing.assert_array_equal(curve["correlation"], own["correlation"])
    z = np.arctanh(pooled.curves.set_index(["layer", "lag"])["correlation"]).groupby(level=[0, 1]).mean()
    mean = pooled.pooled.set_index(["layer", "lag"])["correlation"]
    np.testing.assert_allclose(mean, np.tanh(z.loc[mean.index]))
    assert pooled.pooled.attrs["units"]["lag_s"] == "s"
    assert set(pooled.curves["experiment"]) == {"day 0", "day 1"}
    assert (pooled.path / "pooled.csv").exists()


def test_two_experiments_can_show_nothing_and_that_comes_first(pooled: PooledCorrelation) -> None:
    assert "2 experiments can give p = 0.5 at best" in pooled.sentences[0]
    assert pooled.conditions == ("control",)


def test_resume_keeps_what_is_there_and_other_settings_do_not(batch: Path, pooled: PooledCorrelation) -> None:
    again = run_batch_correlate(batch, "follower", max_lag=6, csv=True, resume=True, **SETTINGS)
    assert again.studies["status"].tolist().count("kept") == 2
    pd.testing.assert_frame_equal(again.pooled, pooled.pooled)
    other = run_batch_correlate(batch, "follower", max_lag=5, resume=True, name="short", **SETTINGS)
    assert other.studies["status"].tolist().count("kept") == 0
    assert open_pooled_correlation(batch, "follower", name="short").pooled["lag"].max() == 5


def test_the_longest_lag_is_that_of_the_movie_in_the_middle(batch: Path) -> None:
    found = run_batch_correlate(batch, "other", **SETTINGS)
    assert found.settings["max_lag"] == 10


def test_a_batch_goes_on_after_it_was_correlated(files: Path, batch: Path, pooled: PooledCorrelation) -> None:
    cd.run_batch(files / "batch.toml", batch, resume=True)
    assert len(open_pooled_correlation(batch, "follower").pooled) == len(pooled.pooled)


def test_a_table_of_groups_takes_the_place_of_those_of_the_batch(batch: Path, tmp_path: Path) -> None:
    table = tmp_path / "groups.csv"
    table.write_text("file,condition,experiment\nm0_masks.tif,drug,day 9\n", encoding="utf-8")
    found = run_batch_correlate(
        batch, "follower", groups=table, max_lag=6, name="own", resume=True, **SETTINGS
    )
    cells = found.cells.set_index("input")
    assert found.conditions == ("drug",)
    assert cells.loc["m0", "experiment"] == "day 9"
    assert cells.loc["m1", ["status", "reason"]].tolist() == ["left out", "it has no condition"]


def test_what_is_asked_wrongly_says_what_there_is(batch: Path) -> None:
    with pytest.raises(ParameterError, match="'VASP' is not in the study: it has 'follower', 'other'"):
        run_batch_correlate(batch, "VASP", **SETTINGS)
    with pytest.raises(ParameterError, match="pass --signal with one of 'follower', 'other'"):
        only_channel(batch)
    with pytest.raises(PopulationError, match="'drug' is not in the batch: it has 'control'"):
        run_batch_correlate(batch, "follower", compare=["control", "drug"], **SETTINGS)
    with pytest.raises(ReadError, match="no correlation of follower with other"):
        open_pooled_correlation(batch, "follower", "other")


def test_the_command_says_what_was_found_and_draws_it(
    batch: Path, pooled: PooledCorrelation, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["correlate", str(batch), "--signal", "follower", "--max-lag", "6", "--resume", "--csv"]
    app([*command, "--surrogates", "0", "--no-geometry", "--no-clusters"], standalone_mode=False)
    said = capsys.readouterr()
    assert "2 of 4 inputs correlated, 2 of them before; 1 left out; 1 refused" in said.out
    assert "2 experiments can give p = 0.5 at best" in said.out
    assert "short refused:" in said.err
    assert (pooled.path / "figures" / "curves.png").exists()
    page = (batch / "report.html").read_text(encoding="utf-8")
    assert "follower with velocity, all movies together" in page
    assert "data:image/png;base64," in page


def test_what_is_for_a_batch_is_refused_with_a_study(batch: Path) -> None:
    with pytest.raises(ParameterError, match="--compare, --groups: only for the folder of a batch"):
        app(
            ["correlate", str(batch / "inputs" / "m0"), "--compare", "a,b", "--groups", "t.csv"],
            standalone_mode=False,
        )
    with pytest.raises(ParameterError, match="--out: not for a batch"):
        app(["report", str(batch), "-o", "page.html"], standalone_mode=False)


def test_each_study_has_a_page_or_a_row_that_says_why(batch: Path) -> None:
    found = write_batch_reports(batch)
    pages = found.table.set_index("input")["page"].to_dict()
    assert pages["m0"] == "inputs/m0/report.html"
    assert (batch / pages["m0"]).exists()
    assert found.table["condition"].tolist()[:2] == ["control", "control"]
    again = write_batch_reports(batch, resume=True)
    assert (again.table.loc[again.table["page"] != "", "status"] == "kept").all()
