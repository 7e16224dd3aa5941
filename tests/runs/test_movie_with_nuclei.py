"""Movies of cells with their nuclei, from files to tables."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from movie_files import LAYERS, SECTORS, Stopped, assert_same_movie, stop_after, write_masks, write_movie
from numpy.testing import assert_allclose

import cytodisk as cd
from cytodisk.errors import NucleusError, ParameterError, StudyError
from cytodisk.runs.movie.movie_inputs import MovieInputs, open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.runs.qc_flags.nucleus_flags import several_nuclei
from cytodisk.runs.told.layer_peak_words import compartment_words
from cytodisk.simulate import MovieWithNuclei

FRAMES, GAP = 7, 4
GRID = MovieParameters(layers=LAYERS, sectors=SECTORS, nucleus_layers=2, renew_every=3)


@pytest.fixture(scope="module")
def truth() -> MovieWithNuclei:
    found = cd.simulate.movie_with_nuclei("migrating", frames=FRAMES, radius_px=18.0)
    found.nuclei[GAP] = False
    return found


@pytest.fixture(scope="module")
def files(truth: MovieWithNuclei, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Path]:
    folder = tmp_path_factory.mktemp("movie")
    masks, signal = write_movie(folder, truth.cell)
    return masks, signal, write_masks(folder / "nuclei.tif", truth.nuclei.astype(np.uint8))


def opened(files: tuple[Path, Path, Path], **settings: object) -> MovieInputs:
    masks, signal, nuclei = files
    return open_movie(masks, signal, GRID.changed(**settings), nuclei=nuclei)


@pytest.fixture(scope="module")
def study(files: tuple[Path, Path, Path], tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    return movie_study(opened(files), tmp_path_factory.mktemp("study") / "out")


@pytest.fixture(scope="module")
def held(files: tuple[Path, Path, Path], tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    return movie_study(opened(files, missing="hold"), tmp_path_factory.mktemp("study") / "out")


def test_frames_have_their_status_and_what_became_of_the_nucleus(study: cd.Study) -> None:
    cells = study.cells.set_index("frame")
    assert cells["status"].tolist() == ["ok"] * GAP + ["refused"] + ["ok"] * (FRAMES - GAP - 1)
    assert "no nucleus" in cells["reason"][GAP]
    assert cells["reason"][GAP].endswith("takes the nucleus of the frame before")
    assert cells["nucleus_status"].tolist() == ["ok"] * GAP + ["none"] + ["ok"] * (FRAMES - GAP - 1)
    assert cells["n_nuclei"].tolist() == [1] * GAP + [0] + [1] * (FRAMES - GAP - 1)
    mapped = cells.drop(index=GAP)
    assert mapped["certificate_valid"].all()
    assert (mapped["nucleus_held"] == "").all()
    assert mapped["nucleus_turn"].abs().max() < 15.0
    table = pd.read_parquet(study.path / "nuclei.parquet")
    assert table["frame"].tolist() == list(range(FRAMES))
    assert table["status"][GAP] == "none"


def test_sums_are_those_of_the_masks_in_every_frame(study: cd.Study, truth: MovieWithNuclei) -> None:
    assert truth.cell.signal is not None
    signal = truth.cell.signal.to_numpy()
    windows = study.windows
    assert windows["layer"].nunique() == LAYERS + 2
    size = truth.cell.pixel_size_um**2
    for frame in set(range(FRAMES)) - {GAP}:
        here = windows[windows["frame"] == frame]
        cell, nucleus = truth.masks[frame], truth.nuclei[frame]
        for name, mask in (("nucleus", nucleus), ("cytoplasm", cell & ~nucleus)):
            part = here[here["compartment"] == name]
            for number, (_, of_channel) in enumerate(part.groupby("channel", sort=False)):
                assert_allclose(of_channel["area"].sum(), mask.sum() * size, rtol=1e-9)
                intensity = (of_channel["mean"] * of_channel["area"]).sum() / size
                assert_allclose(intensity, signal[frame, number][mask].sum(dtype=float), rtol=1e-6)


def test_activity_tells_the_compartment_of_its_layers(study: cd.Study) -> None:
    activity = study.activity(0)
    assert dict(activity.sizes) | {"channel": 0} == {
        "time": FRAMES,
        "channel": 0,
        "layer": LAYERS + 2,
        "sector": SECTORS,
    }
    assert activity["compartment"].to_numpy().tolist() == ["cytoplasm"] * LAYERS + ["nucleus"] * 2
    words = f" (0–{LAYERS - 1} cytoplasm, {LAYERS}–{LAYERS + 1} nucleus)"
    assert compartment_words(study) == words, "which the lines of a correlation say"
    means = activity["mean"].to_numpy()
    assert np.isnan(means[GAP]).all()
    assert np.isfinite(np.delete(means, GAP, axis=0)).all()


def test_the_edge_moves_as_it_does_without_nuclei(
    held: cd.Study, files: tuple[Path, Path, Path], tmp_path: Path
) -> None:
    given = GRID.changed(nucleus_layers=None)
    plain = movie_study(open_movie(files[0], files[1], given), tmp_path / "out")
    assert compartment_words(plain) == ""
    for name in ("velocity", "edge_length"):
        assert_allclose(held.edge[name], plain.edge[name], rtol=1e-6, atol=1e-9)
    for name in ("protruded_area", "retracted_area"):  # a pixel's sector is told by the inside of the map
        assert_allclose(held.edge[name].sum(), plain.edge[name].sum(), rtol=1e-9)


def test_a_nucleus_is_held_on_request(held: cd.Study) -> None:
    cells = held.cells.set_index("frame")
    assert (cells["status"] == "ok").all()
    assert cells.index[cells["nucleus_held"] != ""].tolist() == [GAP]
    assert cells["n_nuclei"][GAP] == 0
    assert cells["nucleus_status"][GAP] == "none"
    assert [bool(words) for words in held.movie(0).nucleus_held] == [frame == GAP for frame in range(FRAMES)]
    warnings = json.loads((held.path / "provenance.json").read_text())["warnings"]
    assert any("nucleus held" in words for words in warnings)


def test_a_held_nucleus_is_not_said_to_be_the_largest_of_several(held: cd.Study) -> None:
    cells = held.cells.assign(n_nuclei=held.cells["n_nuclei"] + (held.cells["frame"] == GAP) * 2)
    assert not list(several_nuclei(replace(held, cells=cells)))
    assert list(several_nuclei(replace(held, cells=cells.assign(nucleus_held=""))))


def test_a_held_nucleus_raises_a_flag(held: cd.Study, study: cd.Study) -> None:
    assert "nucleus held" in held.cells.set_index("frame")["qc_flags"][GAP]
    for found in (held, study):
        assert not found.cells["qc_flags"].str.contains("nucleus missing").any()


def test_the_file_of_nuclei_is_in_the_provenance(study: cd.Study, files: tuple[Path, Path, Path]) -> None:
    text = (study.path / "provenance.json").read_text()
    assert str(files[2]) in text
    assert study.provenance["parameters"]["missing"] == "refuse"


@pytest.mark.parametrize("done", [1, 3, GAP, GAP + 1])
def test_a_stopped_run_goes_on_to_the_same_results(
    files: tuple[Path, Path, Path], held: cd.Study, tmp_path: Path, done: int
) -> None:
    inputs = opened(files, missing="hold")
    with pytest.raises(Stopped):
        movie_study(inputs, tmp_path / "out", progress=stop_after(done))
    assert_same_movie(held, movie_study(inputs, tmp_path / "out", resume=True))


@pytest.mark.slow
def test_two_workers_give_the_same(files: tuple[Path, Path, Path], study: cd.Study, tmp_path: Path) -> None:
    assert_same_movie(study, movie_study(opened(files), tmp_path / "out", workers=2))


def test_a_folder_of_results_is_not_overwritten_unasked(
    files: tuple[Path, Path, Path], study: cd.Study
) -> None:
    with pytest.raises(StudyError):
        movie_study(opened(files), study.path)


def test_layers_of_the_nucleus_are_correlated_as_others(held: cd.Study) -> None:
    channel = held.windows["channel"].iloc[0]
    found = cd.run_correlate(held, channel, max_lag=1, min_pairs=5, surrogates=20)
    assert found.layers["layer"].nunique() == LAYERS + 2


def two_cells(truth: MovieWithNuclei) -> tuple[np.ndarray, np.ndarray]:
    """Labels of two cells side by side, and those of their nuclei, which have other numbers in each frame."""
    masks = np.concatenate([truth.masks, 2 * truth.masks[:, ::-1].astype(np.uint8)], axis=2)
    nuclei = np.concatenate([truth.nuclei, 2 * truth.nuclei[:, ::-1].astype(np.uint8)], axis=2)
    numbers = np.arange(FRAMES, dtype=np.uint8)[:, None, None]
    return masks.astype(np.uint8), np.where(nuclei > 0, nuclei + 10 + 2 * numbers, 0).astype(np.uint8)


def test_nuclei_of_label_movies_go_to_the_cell_that_holds_them(
    truth: MovieWithNuclei, tmp_path: Path
) -> None:
    cells, nuclei = two_cells(truth)
    nuclei[2, cells[2] == 2] = 0
    masks, inner = write_masks(tmp_path / "cells.tif", cells), write_masks(tmp_path / "nuclei.tif", nuclei)
    study = movie_study(open_movie(masks, None, GRID, nuclei=inner), tmp_path / "out")
    rows = study.cells
    bad = [(0, GAP), (1, 2), (1, GAP)]
    assert [(row.cell, row.frame) for row in rows.itertuples() if row.status != "ok"] == bad
    first = rows[(rows["cell"] == 1) & (rows["frame"] == 1)].iloc[0]
    assert first["nuclei"] == "14"
    for cell in (0, 1):
        for frame, disk in enumerate(study.movie(cell)[:2]):
            assert disk.nucleus is not None
            expected = (nuclei[frame] > 0) & (cells[frame] == cell + 1)
            np.testing.assert_array_equal(disk.nucleus.mask, expected)


def test_a_nucleus_without_a_cell_has_its_row(truth: MovieWithNuclei, tmp_path: Path) -> None:
    nuclei = truth.nuclei.astype(np.uint8)
    nuclei[3, :3, :3] = 5
    masks = write_masks(tmp_path / "cells.tif", truth.masks.astype(np.uint8))
    inner = write_masks(tmp_path / "nuclei.tif", nuclei)
    study = movie_study(open_movie(masks, None, GRID, nuclei=inner), tmp_path / "out")
    table = pd.read_parquet(study.path / "nuclei.parquet")
    stray = table[table["cell"].isna()]
    assert stray["frame"].tolist() == [3]
    assert stray["status"].tolist() == ["no cell"]


def test_nuclei_of_another_size_or_number_of_frames_are_refused(
    truth: MovieWithNuclei, files: tuple[Path, Path, Path], tmp_path: Path
) -> None:
    for name, nuclei in (("short", truth.nuclei[:-1]), ("small", truth.nuclei[:, 1:])):
        path = write_masks(tmp_path / f"{name}.tif", nuclei.astype(np.uint8))
        with pytest.raises(NucleusError, match=r"frames|height"):
            open_movie(files[0], None, GRID, nuclei=path)


def test_the_cells_given_as_nuclei_are_refused(files: tuple[Path, Path, Path]) -> None:
    masks, _, nuclei = files
    with pytest.raises(NucleusError, match=r"twice|same"):
        open_movie(masks, None, GRID, nuclei=masks)
    with pytest.raises(NucleusError, match="swapped"):
        open_movie(nuclei, None, GRID, nuclei=masks)


def test_what_does_not_go_with_nuclei_is_refused(files: tuple[Path, Path, Path]) -> None:
    with pytest.raises(ParameterError, match="--interior area"):
        opened(files, interior="still")
    with pytest.raises(ParameterError, match="--nuclei"):
        open_movie(files[0], None, GRID)


def test_a_folder_holds_one_file_of_nuclei_a_frame(
    truth: MovieWithNuclei, files: tuple[Path, Path, Path], tmp_path: Path
) -> None:
    import tifffile

    (tmp_path / "nuclei").mkdir()
    for frame, nucleus in enumerate(truth.nuclei):
        tifffile.imwrite(tmp_path / "nuclei" / f"t{frame:03d}.tif", nucleus.astype(np.uint8))
    inputs = open_movie(files[0], None, GRID, nuclei=tmp_path / "nuclei")
    assert inputs.nuclei is not None
    assert inputs.nuclei.file.n_frames == FRAMES
