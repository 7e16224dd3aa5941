"""`cytodisk population` as a function: what it writes, resumes, refuses."""

import json
import shutil
import warnings
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import cytodisk as cd
from cytodisk.errors import DamagedPartWarning
from cytodisk.runs.population import run_population as module
from cytodisk.runs.population.population_kind import POPULATION
from cytodisk.store.populations.population_columns import TABLES
from cytodisk.store.populations.population_writing import write_population_columns
from cytodisk.store.study_folder import StudyFolder


def _run(folder: Path, out: Path, **settings: object) -> cd.PopulationStudy:
    given = {"groups": folder / "groups.csv"} | settings
    return cd.run_population(folder / "maps", out, **given)


@pytest.fixture(scope="module")
def done(cell_study: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("done") / "atlas"
    _run(cell_study, out, channel=["Rac1"], csv=True)
    return out


def test_all_tables_can_be_read_and_their_columns_are_told(done: Path) -> None:
    study = cd.open_population_study(done)
    told = pd.read_csv(done / "columns.csv")
    for name, columns in TABLES.items():
        table = getattr(study, name)
        if name != "warnings":
            assert list(table)[: len(columns)] == [column.name for column in columns]
            assert set(table) == set(told.loc[told["table"] == f"{name}.parquet", "column"])
        assert (done / f"{name}.csv").exists()
    assert study.conditions == ("control", "drug")
    assert study.compared == ("drug",)
    assert study.channels == ("Rac1",)
    assert len(study.cells) == 16
    assert study.cells.attrs["units"]["area"] == "µm²"
    assert study.atlas.attrs["units"]["mean"] == "a.u."
    assert study.atlas_arrays["mean"].sizes == {"condition": 2, "channel": 1, "layer": 3, "sector": 8}
    assert set(study.scalar_names) >= {"mean_Rac1", "polarity_Rac1", "area"}
    assert study.scalars.set_index("scalar").loc["area", "unit"] == "µm²"


def test_tables_say_what_comparing_in_memory_says(cell_study: Path, done: Path) -> None:
    population = cd.open_population(cell_study / "maps", channels=["Rac1"], groups=cell_study / "groups.csv")
    found = cd.compare_conditions(population, "control", "drug")
    arrays = cd.open_population_study(done).window_arrays("drug").isel(channel=0)
    for name in ("difference", "effect_size", "p_fwer", "cluster"):
        assert arrays[name].to_numpy() == pytest.approx(found.windows[name].to_numpy())
    assert arrays["mean_treated"].to_numpy() == pytest.approx(found.windows["treated"].to_numpy())


def test_what_can_be_reached_is_said_first(done: Path) -> None:
    study = cd.open_population_study(done)
    assert study.sentences[0].startswith("4 + 4 experiments can give p = 0.029 at best")
    assert "unpaired" in study.sentences[1]
    assert any("'control' is taken as the control, by its name" in words for words in study.sentences)
    row = study.comparisons.iloc[0]
    assert row["smallest_p"] == pytest.approx(2 / 70)
    assert (row["n_control"], row["n_treated"], row["design"]) == (4, 4, "unpaired")


def test_provenance_has_the_checksums_of_the_inputs(cell_study: Path, done: Path) -> None:
    inputs = json.loads((done / "provenance.json").read_text(encoding="utf-8"))["inputs"]
    assert inputs["groups"]["path"] == str(cell_study / "groups.csv")
    assert set(inputs["studies"]["files"]) == {"cells.parquet", "windows.parquet"}
    assert len(inputs["studies"]["sha256"]) == 64


def test_a_complete_run_is_not_done_again(cell_study: Path, done: Path) -> None:
    calls: list[tuple[int, int]] = []
    again = _run(cell_study, done, channel=["Rac1"], resume=True, progress=lambda *call: calls.append(call))
    assert not calls
    assert again.comparisons["smallest_p"].iloc[0] == pytest.approx(2 / 70)


def test_other_inputs_or_parameters_are_another_run(cell_study: Path, done: Path, tmp_path: Path) -> None:
    with pytest.raises(cd.errors.StudyError, match="pass --resume to go on, --overwrite to replace it"):
        _run(cell_study, done, channel=["Rac1"])
    with pytest.raises(cd.errors.OtherRunError, match=r"seed: 0 then, 1 now"):
        _run(cell_study, done, channel=["Rac1"], seed=1, resume=True)
    table = pd.read_csv(cell_study / "groups.csv").assign(dish=3)
    table.to_csv(tmp_path / "groups.csv", index=False)
    with pytest.raises(cd.errors.OtherRunError, match=r"groups sha256.* now\): pass --overwrite"):
        _run(cell_study, done, groups=tmp_path / "groups.csv", channel=["Rac1"], resume=True)


def test_a_file_without_cells_is_told(done: Path, tmp_path: Path) -> None:
    shutil.copytree(done, tmp_path / "atlas")
    path = tmp_path / "atlas" / "excluded.parquet"
    rows = [
        {
            "input": "day1",
            "source": "a.tif",
            "frame": None,
            "label": None,
            "reason": "refused: it is cut short",
        },
        {"input": "day2", "source": "b.tif", "frame": 0, "label": 3, "reason": "refused"},
    ]
    pq.write_table(pa.Table.from_pylist(rows, schema=pq.read_schema(path)), path)
    found = cd.open_population_study(tmp_path / "atlas").excluded
    assert found["label"].tolist() == [pd.NA, 3]
    assert found["reason"].tolist() == ["refused: it is cut short", "refused"]


def test_a_seed_of_any_length_can_be_read_again(cell_study: Path, tmp_path: Path) -> None:
    study = _run(cell_study, tmp_path, channel=["Rac1"], seed=2**100, permutations=99)
    assert study.provenance["parameters"]["seed"] == 2**100


def test_a_damaged_provenance_is_told(cell_study: Path, tmp_path: Path) -> None:
    (tmp_path / "provenance.json").write_text('{"status": "comp')
    with pytest.raises(cd.errors.PopulationError, match=r"it has no readable provenance\.json"):
        cd.run_population(tmp_path, tmp_path / "out")


def test_a_scale_of_doses_needs_a_dose() -> None:
    with pytest.raises(cd.errors.ParameterError, match=r"no dose is named: pass --dose COLUMN"):
        cd.PopulationParameters(dose_scale="log")


def test_a_file_that_is_gone_is_made_anew(cell_study: Path, done: Path, tmp_path: Path) -> None:
    out = tmp_path / "atlas"
    shutil.copytree(done, out)
    (out / "columns.csv").unlink()
    (out / "parameters.toml").unlink()
    with pytest.warns(DamagedPartWarning, match="gone or damaged"):
        _run(cell_study, out, channel=["Rac1"], resume=True, progress=_never)
    assert (out / "columns.csv").read_bytes() == (done / "columns.csv").read_bytes()
    assert (out / "parameters.toml").exists()
    (out / "windows.parquet").write_bytes(b"")
    with pytest.warns(DamagedPartWarning, match=r"windows\.parquet gone or damaged"):
        study = _run(cell_study, out, channel=["Rac1"], resume=True)
    assert len(study.windows) == 24


def test_tables_as_csv_are_added_without_a_new_run(cell_study: Path, tmp_path: Path) -> None:
    out = tmp_path / "atlas"
    _run(cell_study, out, channel="Rac1")
    assert not (out / "windows.csv").exists()
    study = _run(cell_study, out, channel="Rac1", csv=True, resume=True, progress=_never)
    assert len(pd.read_csv(out / "windows.csv")) == len(study.windows)


def test_columns_of_curves_are_told_with_their_lag(tmp_path: Path) -> None:
    folder = StudyFolder(tmp_path, {"curves": True, "lag_unit": "s", "signal_unit": "a.u."}, POPULATION)
    write_population_columns(folder)
    told = pd.read_csv(tmp_path / "columns.csv")
    windows = told[told["table"] == "windows.parquet"].set_index("column")["unit"]
    assert windows["lag"] == "s"
    assert windows["difference"] == "a.u."
    assert "sector" not in windows


def _never(done: int, total: int) -> None:
    raise AssertionError("nothing is to be computed")


@pytest.mark.parametrize("table", ["cells", "windows", "warnings"])
def test_a_killed_run_is_done_by_the_next(
    cell_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, table: str
) -> None:
    out, write = tmp_path / "atlas", module.write_population_table

    def killed(folder: object, name: str, *rest: object) -> None:
        if name == table:
            raise KeyboardInterrupt
        write(folder, name, *rest)

    with monkeypatch.context() as patch:
        patch.setattr(module, "write_population_table", killed)
        with pytest.raises(KeyboardInterrupt):
            _run(cell_study, out)
    with pytest.raises(cd.errors.ReadError, match="not complete: run the same command again with --resume"):
        cd.open_population_study(out)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        study = _run(cell_study, out, resume=True)
    assert len(study.cells) == 16


def test_a_wrong_request_changes_no_folder(cell_study: Path, done: Path, tmp_path: Path) -> None:
    out = tmp_path / "atlas"
    with pytest.raises(cd.errors.PopulationError, match="no cell has the condition 'drugs'; there is"):
        _run(cell_study, out, compare=("control", "drugs"))
    assert not list(out.iterdir())
    before = {file.name: file.read_bytes() for file in done.iterdir()}
    with pytest.raises(cd.errors.PopulationError, match="Rac2"):
        _run(cell_study, done, channel=["Rac2"], overwrite=True)
    assert {file.name: file.read_bytes() for file in done.iterdir()} == before


def test_a_population_beside_its_studies_is_none_of_them(cell_study: Path, tmp_path: Path) -> None:
    shutil.copytree(cell_study / "maps", tmp_path / "all" / "maps")
    given = {"groups": cell_study / "groups.csv", "channel": "Rac1"}
    cd.run_population(tmp_path / "all", tmp_path / "all" / "atlas", **given)
    again = cd.run_population(
        tmp_path / "all", tmp_path / "all" / "atlas", resume=True, progress=_never, **given
    )
    assert len(again.cells) == 16


def test_overwriting_replaces_the_run(cell_study: Path, tmp_path: Path) -> None:
    out = tmp_path / "atlas"
    _run(cell_study, out, channel=["Rac1"], csv=True)
    study = _run(cell_study, out, channel=["RhoA"], overwrite=True)
    assert study.channels == ("RhoA",)
    assert not (out / "cells.csv").exists()


def test_cells_of_unknown_experiments_are_described_not_tested(cell_study: Path, tmp_path: Path) -> None:
    study = _run(cell_study, tmp_path / "atlas", groups=cell_study / "no_experiments.csv")
    assert study.sentences[0].startswith("Nothing can be tested")
    assert "cannot be concluded" in study.sentences[1]
    assert [warning.name for warning in study.warnings] == ["experiments unknown"]
    assert study.comparisons["design"].tolist() == ["not tested"]
    windows = study.windows
    assert windows["p"].isna().all()
    assert windows["difference"].notna().all()
    assert not study.experiments["used"].any()
    scalars = study.scalars.set_index("scalar")
    assert set(scalars["status"]) == {"not tested"}
    drug = study.cells[study.cells["condition"] == "drug"]
    assert scalars.loc["area", "mean_treated"] == pytest.approx(drug["area"].mean())


def test_cells_as_units_are_warned_of(cell_study: Path, tmp_path: Path) -> None:
    study = _run(
        cell_study, tmp_path / "atlas", groups=cell_study / "no_experiments.csv", unit="cell", permutations=99
    )
    assert "cells as units" in [warning.name for warning in study.warnings]
    assert study.comparisons["n_control"].tolist() == [8]


def test_cells_without_conditions_are_one_atlas(cell_study: Path, tmp_path: Path) -> None:
    study = cd.run_population(cell_study / "maps", tmp_path / "atlas")
    assert study.conditions == ("all cells",)
    assert study.control == ""
    assert not len(study.comparisons)
    assert "--groups table.csv" in study.sentences[0]
    assert len(study.atlas) == 2 * 3 * 8


def test_parameters_come_back_from_their_file(done: Path) -> None:
    from cytodisk.runs.parameters_file import parameters_from

    found = parameters_from({}, done / "parameters.toml", cd.PopulationParameters)
    assert found == cd.PopulationParameters(channel=("Rac1",))
