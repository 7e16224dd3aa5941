"""The cells of a population's study as a file for scanpy: `--h5ad`."""

import sys
from pathlib import Path

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import MissingPartError
from cytodisk.store.provenance_file import read_provenance


@pytest.mark.slow
def test_the_file_holds_the_cells_that_were_compared(cell_study: Path, tmp_path: Path) -> None:
    anndata = pytest.importorskip("anndata", reason="anndata is not installed")
    settings = {"groups": cell_study / "groups.csv", "channel": ["Rac1"], "normalise": "cell mean"}
    study = cd.run_population(cell_study / "maps", tmp_path / "atlas", h5ad=True, **settings)
    table = anndata.read_h5ad(tmp_path / "atlas" / "population.h5ad")
    assert table.n_obs == len(study.cells)
    assert table.obs["condition"].tolist() == study.cells["condition"].tolist()
    assert table.obs["experiment"].tolist() == study.cells["experiment"].tolist()
    assert set(table.var["channel"]) == {"Rac1"}
    assert table.uns["cytodisk"]["normalise"] == "cell mean"
    assert np.nanmean(table.X) == pytest.approx(1.0, abs=0.1)
    assert (read_provenance(study.path) or {})["files"]["population.h5ad"]
    written = (tmp_path / "atlas" / "population.h5ad").stat().st_mtime_ns
    cd.run_population(cell_study / "maps", tmp_path / "atlas", h5ad=True, resume=True, **settings)
    assert (tmp_path / "atlas" / "population.h5ad").stat().st_mtime_ns == written
    (tmp_path / "atlas" / "population.h5ad").write_bytes(b"cut")
    cd.run_population(cell_study / "maps", tmp_path / "atlas", h5ad=True, overwrite=True, **settings)
    assert anndata.read_h5ad(tmp_path / "atlas" / "population.h5ad").n_obs == table.n_obs


def test_nothing_is_computed_where_anndata_is_missing(
    cell_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "anndata", None)
    with pytest.raises(MissingPartError, match=r"pip install 'cytodisk\[anndata\]'"):
        cd.run_population(
            cell_study / "maps", tmp_path / "atlas", groups=cell_study / "groups.csv", h5ad=True
        )
    assert not (tmp_path / "atlas").exists()
