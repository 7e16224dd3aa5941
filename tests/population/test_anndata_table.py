"""A population as AnnData: what stands where, and that it can be written and read again."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import cytodisk as cd
from cytodisk.errors import MissingPartError
from cytodisk.population.anndata_table import write_h5ad
from cytodisk.population.plain_columns import with_plain_names

ROOM = 4 * 2 * 3 * 5


@pytest.fixture
def population() -> cd.Population:
    """Four cells, two channels, 3 × 5 windows, one window of one cell without a value."""
    numbers = np.arange(ROOM, dtype=np.float32).reshape(4, 2, 3, 5)
    numbers[1, 0, 2, 4] = np.nan
    coords = {"channel": ["Rac1", "actin"], "compartment": ("layer", ["cytoplasm", "cytoplasm", "nucleus"])}
    values = xr.DataArray(
        numbers, dims=("cell", "channel", "layer", "sector"), coords=coords, attrs={"units": "a.u."}
    )
    cells = pd.DataFrame(
        {
            "cell": [1, 2, 1, 2],
            "condition": ["drug", "drug", "control", "control"],
            "experiment": [1, 1, 2, None],
            "plate/well": ["A1", "A2", "A1", None],
            "note": ["a", "b", "c", "d"],
            "mitotic": [True, False, False, True],
            "when": pd.to_datetime(["2026-01-01", "2026-01-02", "2026-01-03", None]),
            "area": [1.0, np.nan, 3.0, 4.0],
            "count": pd.array([1, None, 3, 4], dtype="Int64"),
            "disk_direction_nucleus": [0.0, 72.0, 144.0, np.nan],
            "direction_strength_nucleus": [1.0, 0.5, 1.0, 0.0],
        }
    )
    cells.attrs["units"] = {"area": "µm²"}
    areas = xr.DataArray(np.arange(60.0).reshape(4, 3, 5), dims=("cell", "layer", "sector"))
    return cd.Population(values, cells, areas=areas, scalars=["area"])


@pytest.fixture
def anndata() -> Any:
    return pytest.importorskip("anndata", reason="anndata is not installed")


@pytest.mark.usefixtures("anndata")
def test_each_window_stands_where_var_says(population: cd.Population) -> None:
    table = population.to_anndata()
    assert table.shape == (4, 30)
    assert table.X.dtype == np.float32
    for column, name in enumerate(table.var_names):
        where = table.var.loc[name]
        values = population.raw.sel(channel=where["channel"])[:, where["layer"], where["sector"]]
        np.testing.assert_array_equal(table.X[:, column], values)
        assert name == f"{where['channel']}_layer{where['layer']}_sector{where['sector']}"
        assert (where["compartment"] == "nucleus") == (where["layer"] == 2)
    assert table.var["cells"].tolist() == [4] * 14 + [3] + [4] * 15


@pytest.mark.usefixtures("anndata")
def test_a_change_of_the_table_does_not_reach_the_population(population: cd.Population) -> None:
    before = population.raw.copy()
    table = population.to_anndata()
    table.X[:] = 0
    table.obsm["window_areas"][:] = 0
    xr.testing.assert_identical(population.raw, before)
    assert population.areas is not None
    assert float(population.areas.max()) == 59.0


def test_it_comes_back_from_a_file(population: cd.Population, anndata: Any, tmp_path: Path) -> None:
    write_h5ad(population, tmp_path / "population.h5ad")
    assert [path.name for path in tmp_path.iterdir()] == ["population.h5ad"]
    table, read = population.to_anndata(), anndata.read_h5ad(tmp_path / "population.h5ad")
    np.testing.assert_array_equal(read.X, table.X)
    assert read.obs_names.tolist() == table.obs_names.tolist()
    assert read.var_names.tolist() == table.var_names.tolist()
    for name in table.obs:
        given = table.obs[name]
        kept = read.obs[name]
        assert kept.isna().tolist() == given.isna().tolist(), name
        assert kept.dropna().tolist() == given.dropna().tolist(), name
    assert {*read.obsm} == {*table.obsm} == {"scalars", "direction_nucleus", "window_areas"}
    np.testing.assert_array_equal(read.obsm["scalars"], table.obsm["scalars"])
    assert read.uns["cytodisk"]["units"] == {"values": "a.u.", "area": "µm²"}
    assert read.uns["cytodisk"]["grid"] == {"channels": 2, "layers": 3, "sectors": 5, "nucleus_layers": 1}


@pytest.mark.usefixtures("anndata")
def test_what_was_done_to_cells(population: cd.Population) -> None:
    obs = population.to_anndata().obs
    assert obs["condition"].cat.categories.tolist() == ["drug", "control"]
    assert obs["experiment"].tolist()[:3] == ["1", "1", "2"]
    assert obs["experiment"].isna().tolist() == [False, False, False, True]
    assert obs["plate_well"].cat.categories.tolist() == ["A1", "A2"]
    assert obs["note"].dtype == object
    assert obs["mitotic"].dtype == bool
    assert obs["count"].dtype == np.float64
    assert obs["when"].tolist()[0] == "2026-01-01 00:00:00"
    assert len(set(obs.index)) == 4
    assert "control/2/1" in obs.index  # condition, experiment, cell: no shorter name is unique


@pytest.mark.usefixtures("anndata")
def test_cells_are_named_as_shortly_as_is_unique(population: cd.Population) -> None:
    def named(**columns: Any) -> list[str]:
        return cd.Population(population.raw, pd.DataFrame(columns)).to_anndata().obs_names.tolist()

    assert named(cell=["a", "b", "c", "d"]) == ["a", "b", "c", "d"]
    assert named(input=["m", "m", "n", "n"], cell=[1, 2, 1, 2.0]) == ["m/1", "m/2", "n/1", "n/2"]
    assert named(cell=["a", "a", "a", "b"]) == ["a", "a-1", "a-2", "b"]
    assert named(dose=[1, 2, 3, 4]) == ["cell0", "cell1", "cell2", "cell3"]


@pytest.mark.usefixtures("anndata")
def test_directions_and_areas_turn_with_the_windows(population: cd.Population) -> None:
    table = population.align("nucleus").normalise("cell mean").to_anndata()
    notes = table.uns["cytodisk"]
    assert (notes["align"], notes["normalise"]) == ("nucleus", "cell mean")
    assert notes["units"]["values"] == "× cell mean"
    np.testing.assert_allclose(table.obsm["direction_nucleus"][:3], [[1, 0], [0.5, 0], [1, 0]], atol=1e-12)
    assert np.isnan(table.obsm["direction_nucleus"][3]).all()
    assert table.obs["alignment_shift"].tolist() == [0, 1, 2, 0]
    assert population.areas is not None
    np.testing.assert_array_equal(
        table.obsm["window_areas"][2].reshape(3, 5), np.roll(population.areas[2].to_numpy(), -2, axis=-1)
    )


@pytest.mark.usefixtures("anndata")
def test_scalars_alone_take_the_place_of_windows() -> None:
    cells = pd.DataFrame({"condition": ["a", "b"], "area": [1.0, 2.0], "solidity": [0.5, np.nan]})
    cells.attrs["units"] = {"area": "µm²"}
    table = cd.Population(None, cells, scalars=["area", "solidity"]).to_anndata()
    np.testing.assert_array_equal(table.X, [[1.0, 0.5], [2.0, np.nan]])
    assert table.var["unit"].tolist() == ["µm²", ""]
    assert table.var["cells"].tolist() == [2, 1]


@pytest.mark.usefixtures("anndata")
def test_curves_have_lags_in_the_place_of_sectors() -> None:
    values = xr.DataArray(
        np.zeros((2, 1, 3)), dims=("cell", "layer", "lag"), coords={"lag": [-2.5, 0.0, 2.5]}, name="Rac1"
    )
    table = cd.Population(values, pd.DataFrame(index=range(2))).to_anndata()
    assert table.var["lag"].tolist() == [-2.5, 0.0, 2.5]
    assert table.var_names[0] == "Rac1_layer0_lag-2.5"


def test_without_anndata_it_says_what_to_install(
    population: cd.Population, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "anndata", None)
    with pytest.raises(MissingPartError, match=r"pip install 'cytodisk\[anndata\]'"):
        population.to_anndata()


def test_names_that_a_file_cannot_have() -> None:
    table = with_plain_names(pd.DataFrame([[1, 2, 3]], columns=["a/b", "a_b", "_index"]), ["x"])
    assert table.columns.tolist() == ["a_b", "a_b-1", "index"]
    assert table.columns.dtype == object
