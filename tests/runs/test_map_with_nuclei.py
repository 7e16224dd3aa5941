"""Runs over cells with nuclei: what the tables say of every case."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import NucleusError, ParameterError, SignalError, StudyError
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.cells.cell_parameters import CheckParameters
from cytodisk.runs.map.checked_cells import check_cells

SHAPE = (110, 260)
GRID = {"layers": 3, "sectors": 6, "nucleus_layers": 2}


def drawn(*boxes: tuple[int, int, int, int, int]) -> np.ndarray:
    """Boxes: label, first row, row after the last, first column, column after the last."""
    labels = np.zeros(SHAPE, dtype=np.uint16)
    for label, top, bottom, left, right in boxes:
        labels[top:bottom, left:right] = label
    return labels


CELLS = drawn((1, 10, 60, 10, 60), (2, 10, 60, 60, 120), (3, 10, 60, 130, 180), (4, 10, 60, 190, 250))
ONE_EACH = drawn((11, 25, 45, 25, 40), (12, 25, 45, 80, 95), (13, 20, 30, 140, 150), (14, 20, 45, 215, 230))


@pytest.fixture(autouse=True)
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def write(name: str, image: np.ndarray, **metadata: object) -> str:
    Path(name).parent.mkdir(exist_ok=True)
    tifffile.imwrite(name, image, **metadata)  # type: ignore[arg-type]
    return name


def mapped(cells: np.ndarray, nuclei: np.ndarray, **settings: object) -> cd.Study:
    """A study of these label images."""
    files = {"nuclei": write("nuclei.tif", nuclei)}
    return cd.run_map(write("cells.tif", cells), "out", **files, **GRID | settings)  # type: ignore[arg-type]


def table(study: cd.Study) -> pd.DataFrame:
    return pd.read_parquet(study.path / "nuclei.parquet")


def test_each_cell_is_mapped_with_its_nucleus() -> None:
    signal = np.where(ONE_EACH > 0, 10.0, np.where(CELLS > 0, 2.0, 0.0)).astype(np.float32)
    study = mapped(CELLS, ONE_EACH, signal=write("signal.tif", signal))
    cells = study.cells.set_index("label")
    assert cells["status"].tolist() == ["ok"] * 4
    assert cells["nuclei"].tolist() == ["11", "12", "13", "14"]
    assert cells["n_nuclei"].tolist() == [1] * 4
    assert cells["nucleus_status"].tolist() == ["ok"] * 4
    assert cells["nucleus_area_px"].tolist() == [300, 300, 100, 375]
    assert cells["certificate_valid"].all()
    assert (cells["qc_flags"] == "").all()
    windows = study.windows[study.windows["cell"] == 0]
    assert windows["layer"].unique().tolist() == [0, 1, 2, 3, 4]
    disk = study.map(0)
    assert disk.nucleus_radius == 0.5
    assert disk.nucleus is not None
    assert disk.nucleus.mask.sum() == 300
    np.testing.assert_array_equal(disk.nucleus.mask, ONE_EACH == 11)  # at its place in the whole image


def test_layers_of_the_nucleus_are_three_unless_the_run_says_otherwise() -> None:
    study = mapped(CELLS == 1, ONE_EACH == 11, nucleus_layers=None)
    assert study.windows["layer"].nunique() == 3 + 3
    assert study.provenance["parameters"]["nucleus_layers"] == 3


def test_a_mask_of_nuclei_is_matched_by_overlap() -> None:
    study = mapped(CELLS, (ONE_EACH > 0).astype(np.uint8))
    assert study.cells["status"].tolist() == ["ok"] * 4
    assert study.cells["nuclei"].tolist() == ["3", "4", "1", "2"]


FAULTS = drawn(
    (1, 25, 45, 40, 70),  # cells 1 and 2 share it
    (3, 20, 30, 140, 150),
    (4, 40, 50, 155, 165),  # a second one of cell 3
    (7, 90, 100, 200, 210),  # in no cell
)


def test_every_case_has_its_row() -> None:
    study = mapped(CELLS | drawn((5, 70, 100, 10, 100)), FAULTS | drawn((14, 5, 30, 215, 230)))
    cells = study.cells.set_index("label")
    assert cells["nucleus_status"].tolist() == ["shared", "shared", "several", "partly outside", "none"]
    assert cells["status"].tolist() == ["refused"] * 5
    assert cells["n_nuclei"].tolist() == [1, 0, 2, 1, 0]
    reasons = cells["reason"].tolist()
    assert reasons[0] == (
        "the cell shares a nucleus (of nucleus 1, 67 % lie in label 1 and 33 % in label 2): the border of "
        "the cells cuts it, or two nuclei touch and count as one: correct the masks"
    )
    assert reasons[1] == reasons[0]
    assert reasons[2].startswith("the cell has 2 nuclei, of 100 and 100 px: split it if")
    assert reasons[3].startswith("20 % of the nucleus lies outside the cell")
    assert reasons[4] == (
        "no nucleus lies in the cell: correct the masks, or map such cells without (--missing plain)"
    )
    rows = table(study)
    assert rows["status"].tolist() == [
        "shared", "no cell", "shared", "several", "partly outside", "none"
    ]  # fmt: skip
    stray = rows[rows["cell"].isna()]
    assert stray[["nuclei", "reason"]].to_numpy().tolist() == [["7", "it lies in no cell"]]
    assert study.provenance["warnings"][0] == (
        "1 nucleus lies in no cell: the table of nuclei lists what no cell holds"
    )


def test_several_nuclei_as_the_user_wants() -> None:
    largest = mapped(CELLS == 3, np.where(CELLS == 3, FAULTS, 0), several="largest").cells.iloc[0]
    assert (largest["status"], largest["n_nuclei"], largest["nucleus_dropped_px"]) == ("ok", 2, 100)
    assert largest["nucleus_remarks"] == "the largest of 2 nuclei taken (100 px dropped)"
    assert largest["qc_flags"] == "several nuclei"
    joined = mapped(CELLS == 3, np.where(CELLS == 3, FAULTS, 0), several="join", overwrite=True).cells.iloc[0]
    assert joined["nucleus_area_px"] == 200 + joined["nucleus_joined_px"]


def test_touching_nuclei_with_labels_of_their_own_are_several() -> None:
    study = mapped(CELLS == 1, drawn((1, 20, 40, 20, 30), (2, 20, 40, 30, 40)))
    assert study.cells["reason"].iloc[0].startswith("the cell has 2 nuclei, of 200 and 200 px")


def test_a_nucleus_at_the_edge_is_clipped_and_flagged() -> None:
    row = mapped(CELLS == 1, drawn((1, 9, 45, 25, 31))).cells.iloc[0]
    assert (row["nucleus_outside_px"], row["nucleus_clipped_px"], row["nucleus_area_px"]) == (6, 6, 34 * 6)
    assert row["qc_flags"] == "nucleus clipped"
    assert 0 < row["nucleus_clipped_share"] < 0.2


def test_cells_without_a_nucleus_are_mapped_without_on_request() -> None:
    signal = write("signal.tif", CELLS.astype(np.float32))
    study = mapped(CELLS, np.where(CELLS == 1, 0, ONE_EACH), missing="plain", signal=signal)
    assert study.cells["status"].tolist() == ["ok"] * 4
    assert study.cells["qc_flags"].tolist() == ["nucleus missing", "", "", ""]
    windows = study.windows[study.windows["cell"] == 0]
    assert windows["status"].tolist() == ["ok"] * 18 + ["no nucleus"] * 12
    assert windows["mean"].isna().tolist() == [False] * 18 + [True] * 12
    assert windows["area"].sum() == pytest.approx(2500)
    assert study.map(0).nucleus is None


def test_a_nucleus_in_a_hole_of_the_mask_belongs_to_the_cell() -> None:
    study = mapped(np.where(ONE_EACH > 0, 0, CELLS), ONE_EACH)
    assert study.cells["status"].tolist() == ["ok"] * 4
    assert study.cells["nucleus_area_px"].tolist() == [300, 300, 100, 375]


def test_stacks_go_frame_by_frame() -> None:
    cells = np.stack([CELLS == 1, CELLS == 2]).astype(np.uint8)
    nuclei = np.stack([ONE_EACH == 11, ONE_EACH == 12]).astype(np.uint8)
    study = mapped(cells, nuclei)
    assert study.cells["nuclei"].tolist() == ["1", "1"]
    with pytest.raises(NucleusError, match=r"nuclei\.tif have 5 frames, the masks 2: pass as many"):
        mapped(cells, np.stack([ONE_EACH] * 5), overwrite=True)


@pytest.mark.parametrize(
    ("nuclei", "words"),
    [
        (CELLS, "covered by a nucleus: are these the masks of the cells twice"),
        (np.where(CELLS == 3, 1, CELLS > 0).astype(np.uint8), "inside a nucleus|covered by a nucleus"),
        (ONE_EACH[:, 1:], r"have images of \(110, 259\), the masks of \(110, 260\)"),
        (np.random.default_rng(0).poisson(99, SHAPE).astype(np.uint16), r"picture.*--nuclei-kind labels"),
        ((ONE_EACH == 0).astype(np.uint8), r"looks inverted.*--nuclei-kind mask"),
        (np.stack([ONE_EACH, CELLS, CELLS], axis=-1).astype(np.uint8), "--nuclei-channel 0"),
    ],
)
def test_what_are_no_nuclei_is_refused_before_the_run(nuclei: np.ndarray, words: str) -> None:
    with pytest.raises(NucleusError, match=words):
        mapped(CELLS, nuclei)
    assert not Path("out").exists()


def test_swapped_files_are_refused() -> None:
    with pytest.raises(NucleusError, match="4 of 4 cells lie inside a nucleus: are the two swapped"):
        mapped(ONE_EACH, CELLS)


def test_a_channel_of_the_file_of_nuclei(tmp_path: Path) -> None:
    both = np.stack([CELLS, ONE_EACH])
    tifffile.imwrite("both.ome.tif", both, metadata={"axes": "CYX"})
    study = cd.run_map(write("cells.tif", CELLS), "out", nuclei="both.ome.tif", nuclei_channel="1", **GRID)
    assert study.cells["nuclei"].tolist() == ["11", "12", "13", "14"]


def test_scales_that_contradict_are_refused() -> None:
    scale = {"metadata": {"axes": "YX", "PhysicalSizeX": 0.2, "PhysicalSizeY": 0.2}}
    other = {"metadata": {"axes": "YX", "PhysicalSizeX": 0.5, "PhysicalSizeY": 0.5}}
    masks, nuclei = write("cells.ome.tif", CELLS, **scale), write("nuclei.ome.tif", ONE_EACH, **other)
    with pytest.raises(SignalError, match=r"pixel sizes differ: .* 0\.2 µm, .*nuclei.* 0\.5 µm"):
        cd.run_map(masks, "out", nuclei=nuclei, **GRID)
    study = cd.run_map(write("plain.tif", CELLS), "out", nuclei=nuclei, **GRID)
    assert study.scale.pixel_size_um == 0.5  # what the nuclei alone know


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"several": "largest"}, "several is given, but there are no nuclei: pass them as --nuclei"),
        ({"missing": "plain"}, "take --missing out"),
        ({"nucleus_layers": 3}, "take --nucleus-layers out"),
        ({"nucleus_radius": "area"}, "take --nucleus-radius out"),
        ({"nuclei_channel": "1"}, "take --nuclei-channel out"),
        ({"align": "nucleus"}, 'align "nucleus" needs nuclei: pass them as --nuclei'),
    ],
)
def test_what_is_said_of_nuclei_needs_nuclei(settings: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        cd.run_map(write("cells.tif", CELLS), "out", layers=3, sectors=6, **settings)


def test_other_methods_map_no_nuclei() -> None:
    with pytest.raises(ParameterError, match="nuclei need method \"newton\", got 'harmonic'"):
        mapped(CELLS, ONE_EACH, method="harmonic")


def test_other_nuclei_are_another_run() -> None:
    study = mapped(CELLS, ONE_EACH)
    assert study.provenance["inputs"]["nuclei"]["read as"] == "a label image, YX (110, 260) uint16"
    before = (study.path / "cells.parquet").read_bytes()
    mapped(CELLS, ONE_EACH, resume=True)
    assert (study.path / "cells.parquet").read_bytes() == before
    with pytest.raises(StudyError, match="holds another run"):
        mapped(CELLS, np.where(ONE_EACH == 11, 0, ONE_EACH), resume=True)
    with pytest.raises(StudyError, match="holds another run"):
        cd.run_map("cells.tif", "out", layers=3, sectors=6, resume=True)


def test_the_file_of_nuclei_is_never_removed() -> None:
    mapped(CELLS, ONE_EACH)
    nuclei = Path("out/nuclei.parquet")
    nuclei.unlink()
    nuclei.symlink_to(Path("nuclei.tif").absolute())
    with pytest.raises(StudyError, match="is among the results in out, which --overwrite removes"):
        mapped(CELLS, ONE_EACH, overwrite=True)
    assert Path("nuclei.tif").exists()


def test_a_run_without_nuclei_in_the_place_of_one_with() -> None:
    mapped(CELLS, ONE_EACH)
    study = cd.run_map("cells.tif", "out", layers=3, sectors=6, overwrite=True)
    assert "n_nuclei" not in study.cells
    assert not (study.path / "nuclei.parquet").exists()


def test_folders_pair_by_name() -> None:
    for name, cell in (("a", 1), ("b", 2), ("c", 3)):
        write(f"masks/{name}_masks.tif", (cell == CELLS).astype(np.uint8))
        if name != "c":
            write(f"nuclei/{name}.tif", (cell + 10 == ONE_EACH).astype(np.uint8))
    study = cd.run_map("masks", "out", nuclei="nuclei", **GRID)
    cells = study.cells.set_index("source")
    assert cells["status"].tolist() == ["ok", "ok", "refused"]
    assert cells["nucleus_status"].tolist() == ["ok", "ok", "unusable"]
    assert "c_masks.tif has no file of nuclei in nuclei" in cells["reason"].iloc[2]
    assert study.provenance["inputs"]["nuclei"]["files"].keys() == {"a.tif", "b.tif"}


def test_a_folder_with_nuclei_beside_the_masks_and_other_scales() -> None:
    for name, cell, size in (("a", 1, 0.2), ("b", 2, 0.2), ("c", 3, 0.7)):
        write(f"all/{name}.tif", (cell == CELLS).astype(np.uint8))
        metadata = {"axes": "YX", "PhysicalSizeX": size, "PhysicalSizeY": size}
        tifffile.imwrite(
            f"all/{name}_nuclei.ome.tif", (cell + 10 == ONE_EACH) * np.uint8(1), metadata=metadata
        )
    study = cd.run_map("all", "out", nuclei="_nuclei", **GRID)
    assert study.cells["source"].tolist() == ["a.tif", "b.tif", "c.tif"]
    assert study.cells["status"].tolist() == ["ok", "ok", "refused"]
    assert "have pixels of 0.7 µm, the run 0.2 µm" in study.cells["reason"].iloc[2]
    assert study.scale.pixel_size_um == 0.2


def test_two_workers_and_one_write_the_same() -> None:
    one = mapped(CELLS, ONE_EACH | drawn((7, 90, 100, 200, 210)))
    tables = {name: (one.path / f"{name}.parquet").read_bytes() for name in ("nuclei", "windows")}
    two = mapped(CELLS, ONE_EACH | drawn((7, 90, 100, 200, 210)), workers=2, overwrite=True)
    assert {name: (two.path / f"{name}.parquet").read_bytes() for name in tables} == tables


def test_check_says_what_the_run_would() -> None:
    paths = write("cells.tif", CELLS), write("nuclei.tif", np.where(CELLS == 4, ONE_EACH, FAULTS))
    inputs = open_inputs(paths[0], None, CheckParameters(), nuclei=paths[1])
    checked = list(check_cells(inputs))
    assert [found.status for found in checked] == ["refused", "refused", "refused", "ok"]
    assert "shares a nucleus" in checked[0].reason
    assert checked[3].nucleus_report is not None
    assert checked[3].nucleus_report.area_px == 375
    assert [len(found.nucleus.strays) for found in checked if found.nucleus] == [1, 0, 0, 0]
    policies = CheckParameters(several="largest", missing="plain")
    with_policies = list(check_cells(open_inputs(paths[0], None, policies, nuclei=paths[1])))
    assert [found.status for found in with_policies] == ["refused", "refused", "ok", "ok"]


def test_cells_without_a_nucleus_have_no_direction_of_it() -> None:
    with pytest.raises(ParameterError, match="take --missing plain out, or choose another --align"):
        mapped(CELLS, ONE_EACH, missing="plain", align="nucleus")


def test_swapped_folders_are_refused() -> None:
    for name, cell in (("a", 1), ("b", 2)):
        write(f"masks/{name}.tif", (cell == CELLS).astype(np.uint8))
        write(f"nuclei/{name}.tif", (cell + 10 == ONE_EACH).astype(np.uint8))
    with pytest.raises(NucleusError, match="1 of 1 cells lie inside a nucleus: are the two swapped"):
        cd.run_map("nuclei", "out", nuclei="masks", **GRID)


def test_outlines_of_nuclei_have_the_size_of_the_masks() -> None:
    corners = [[[25, 25], [40, 25], [40, 45], [25, 45], [25, 25]]]
    nucleus = {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": corners}}
    Path("nuclei.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [nucleus]}))
    masks = write("cells.tif", (CELLS == 1).astype(np.uint8))
    study = cd.run_map(masks, "out", nuclei="nuclei.geojson", **GRID)
    assert study.cells[["status", "nucleus_area_px"]].to_numpy().tolist() == [["ok", 300]]


def test_a_simulated_field_comes_back_as_it_was_made() -> None:
    field = cd.simulate.label_image_with_nuclei(cells=8, seed=3)
    study = mapped(field.cells, field.nuclei)
    truth = field.truth[field.truth["cell"] > 0].set_index("cell")
    cells = study.cells.set_index("label")
    words = {"one": "ok", "two": "several", "partly outside": "ok"}  # by less than a tenth, which is clipped
    assert cells["nucleus_status"].to_dict() == truth["case"].replace(words).to_dict()
    usual = truth["case"] != "shared"
    assert cells["nuclei"][usual].map(labels_of).to_dict() == truth["nuclei"][usual].map(labels_of).to_dict()
    clipped = cells["qc_flags"] == "nucleus clipped"
    assert clipped[clipped].index.tolist() == truth.index[truth["case"] == "partly outside"].tolist()
    found = table(study).dropna(subset="cell").set_index("label")["overlap"]
    np.testing.assert_allclose(found[usual], truth["overlap"][usual])
    strays = table(study)["cell"].isna().sum()
    assert strays == (field.truth["case"] == "no cell").sum() > 0


def labels_of(text: str) -> set[str]:
    return set(text.split(","))
