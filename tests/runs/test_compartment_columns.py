"""Numbers of nucleus and cytoplasm in the tables of a study."""

from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import tifffile
from numpy.testing import assert_allclose

import cytodisk as cd
from cytodisk.errors import ReadError
from cytodisk.runs.told.nucleus_words import nucleus_ratio_words, nucleus_share_words

CENTRES, SHIFTS = ((40, 40), (40, 130), (40, 220)), ((0, 0), (0, 12), (-9, 12))  # (row, column) of cells
RADIUS, NUCLEUS = 30, 10
GRID = {"layers": 6, "sectors": 12, "nucleus_layers": 2, "pixel_size_um": 0.5}
NUMBERS = ("nucleus_to_cytoplasm", "ratio_of_totals", "perinuclear_share", "peripheral_share")


@pytest.fixture(autouse=True)
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def drawn() -> tuple[np.ndarray, np.ndarray]:
    """Three round cells and their nuclei: in the middle, to the right, and up to the right."""
    y, x = np.indices((80, 270))
    cells, nuclei = np.zeros((80, 270), np.uint16), np.zeros((80, 270), np.uint16)
    for label, ((row, column), (down, right)) in enumerate(zip(CENTRES, SHIFTS, strict=True), 1):
        cells[np.hypot(y - row, x - column) <= RADIUS] = label
        nuclei[np.hypot(y - row - down, x - column - right) <= NUCLEUS] = label
    return cells, nuclei


def images(background: float = 0.0) -> np.ndarray:
    """DAPI, eight times as bright in the nucleus, and GFP, which it leaves out."""
    cells, nuclei = drawn()
    dapi = np.where(nuclei > 0, 80.0, np.where(cells > 0, 10.0, 0.0))
    gfp = np.where(nuclei > 0, 5.0, np.where(cells > 0, 20.0, 0.0))
    return np.stack([dapi, gfp]).astype(np.float32) + np.float32(background)


def study_of(signal: np.ndarray | None, name: str = "out", **settings: object) -> cd.Study:
    cells, nuclei = drawn()
    tifffile.imwrite("cells.tif", cells)
    tifffile.imwrite("nuclei.tif", nuclei)
    if signal is not None:
        tifffile.imwrite("signal.tif", signal, metadata={"axes": "CYX"}, photometric="minisblack")
        settings |= {"signal": "signal.tif", "channels": ("DAPI", "GFP")}
    return cd.run_map("cells.tif", name, nuclei="nuclei.tif", **GRID | settings)  # type: ignore[arg-type]


def flags_of(study: cd.Study) -> dict[str, object]:
    return {flag.name: flag for flag in cd.qc_flags(study)}


def test_cells_have_the_numbers_of_each_channel() -> None:
    cells = cd.open_study(study_of(images()).path).cells
    cell, nucleus = drawn()[0] == 2, drawn()[1] == 2
    assert_allclose(cells["nucleus_to_cytoplasm_DAPI"], 8.0)
    assert_allclose(cells["nucleus_to_cytoplasm_GFP"], 0.25)
    assert_allclose(cells["nucleus_mean_GFP"], 5.0)
    assert_allclose(cells["cytoplasm_mean_GFP"], 20.0)
    totals = 8.0 * nucleus.sum() / (cell & ~nucleus).sum()
    assert_allclose(cells["ratio_of_totals_DAPI"], totals, rtol=0.02)
    assert_allclose(cells[["perinuclear_share_GFP", "peripheral_share_GFP"]], 1 / 3)
    assert_allclose(cells["signal_polarity_GFP"], 0.0, atol=1e-9)
    assert_allclose(cells["darkest_around_DAPI"], 0.0)
    units = cells.attrs["units"]
    assert (units["nucleus_area"], units["nucleus_offset"], units["nucleus_direction"]) == ("µm²", "µm", "°")


def test_cells_have_the_place_of_their_nucleus() -> None:
    cells = study_of(None).cells
    assert_allclose(cells["nucleus_offset"], [0.0, 6.0, 7.5], atol=1e-9)
    assert_allclose(cells["nucleus_area"], 0.25 * cells["nucleus_area_px"])
    assert_allclose(cells["nucleus_polarity"], cells["nucleus_offset"] / np.sqrt(cells["area"] / np.pi))
    assert_allclose(cells["nucleus_direction"], [np.nan, 180.0, 180.0 - np.degrees(np.arctan2(9, 12))])
    assert not [name for name in cells if name.startswith(("nucleus_to_cytoplasm", "nucleus_signal"))]


def test_numbers_are_those_of_nucleus_summary() -> None:
    signal = images() + np.random.default_rng(0).random((2, 80, 270)).astype(np.float32)
    signal[1] += np.indices((80, 270))[1].astype(np.float32) / 9.0
    study = study_of(signal)
    disk = study.map(1)
    data = cd.sample(cd.polar_windows(6, 12, nucleus_layers=2).on(disk), signal)
    summary, row = cd.nucleus_summary(disk, data), study.cells.iloc[1]
    names = [name for name in summary.data_vars if name != "reason"]
    for name in names:
        for channel, label in enumerate(("DAPI", "GFP")):
            column, values = name, summary[name].to_numpy()
            if values.ndim:
                column, values = f"{name}_{label}", values[channel]
            assert row[column] == pytest.approx(float(values), rel=1e-6, nan_ok=True), column
    assert np.isfinite(row["signal_direction_GFP"])


def test_the_profile_of_a_study_is_that_of_nuclear_profile() -> None:
    signal = images() + np.random.default_rng(0).random((2, 80, 270)).astype(np.float32)
    study = study_of(signal)
    table = study.nuclear_profile
    assert len(table) == 3 * 2 * 8
    disk = study.map(2)
    profile = cd.nuclear_profile(cd.sample(cd.polar_windows(6, 12, nucleus_layers=2).on(disk), signal))
    rows = table[(table["cell"] == 2) & (table["channel"] == "GFP")]
    assert rows["compartment"].tolist() == profile["compartment"].to_numpy().tolist()
    for name in ("mean", "sd", "n_windows", "share", "depth", "nucleus_distance"):
        values = profile[name].to_numpy()
        wanted = values[1] if values.ndim == 2 else values
        assert_allclose(rows[name], wanted, rtol=1e-6, atol=1e-9, err_msg=name)
    assert_allclose(rows["area"], 0.25 * profile["area"], rtol=1e-9)
    assert table.attrs["units"]["nucleus_distance"] == "µm"


def test_a_study_without_nuclei_has_no_profile() -> None:
    tifffile.imwrite("cells.tif", drawn()[0])
    study = cd.run_map("cells.tif", "plain", layers=2, sectors=4)
    assert not [name for name in study.cells if name.startswith("nucleus")]
    with pytest.raises(ReadError, match="make it again with --nuclei"):
        _ = study.nuclear_profile


def test_a_cell_without_a_nucleus_has_no_numbers_of_one() -> None:
    cells, nuclei = drawn()
    nuclei[nuclei == 2] = 0
    tifffile.imwrite("some.tif", nuclei)
    tifffile.imwrite("cells.tif", cells)
    tifffile.imwrite("signal.tif", images(), metadata={"axes": "CYX"}, photometric="minisblack")
    given = {"nuclei": "some.tif", "signal": "signal.tif", "channels": ("DAPI", "GFP"), "missing": "plain"}
    study = cd.run_map("cells.tif", "out", **given, **GRID)  # type: ignore[arg-type]
    row = study.cells.iloc[1]
    assert (row["status"], row["nucleus_status"]) == ("ok", "none")
    assert row[["nucleus_area", "nucleus_offset", "nucleus_to_cytoplasm_GFP"]].isna().all()
    assert study.cells["nucleus_to_cytoplasm_GFP"].notna().sum() == 2
    profile = study.nuclear_profile
    plain = profile[(profile["cell"] == 1) & (profile["channel"] == "GFP")]
    assert plain["compartment"].tolist() == ["cell"] * 6 + ["nucleus"] * 2
    assert plain["mean"].notna().tolist() == [True] * 6 + [False] * 2
    assert "no nucleus ratio" not in flags_of(study)


def test_background_that_was_left_in_is_flagged() -> None:
    assert "background" not in flags_of(study_of(images(), "without"))
    study = study_of(images(background=10.0), "with")
    flag = flags_of(study)["background"]
    assert "DAPI 50%, GFP 33%" in flag.what  # type: ignore[attr-defined]
    assert_allclose(study.cells["nucleus_to_cytoplasm_DAPI"], 4.5)
    by_hand = (study.cells["nucleus_mean_DAPI"] - 10.0) / (study.cells["cytoplasm_mean_DAPI"] - 10.0)
    assert_allclose(by_hand, 8.0)


def test_a_ratio_that_cannot_be_is_empty_and_flagged_with_the_reason() -> None:
    study = study_of(images(background=-20.0))
    assert study.cells["nucleus_to_cytoplasm_GFP"].isna().all()
    assert study.cells["nucleus_to_cytoplasm_DAPI"].isna().all()
    flag = flags_of(study)["no nucleus ratio"]
    assert [place.cell for place in flag.places] == [0, 1, 2]  # type: ignore[attr-defined]
    assert "GFP: the mean of the cytoplasm is 0 or below" in flag.places[0].note  # type: ignore[attr-defined]


def test_a_nucleus_in_the_middle_is_flagged() -> None:
    flag = flags_of(study_of(None))["nucleus in the middle"]
    assert [place.cell for place in flag.places] == [0]  # type: ignore[attr-defined]
    assert study_of(None, "again").cells["qc_flags"].tolist() == ["nucleus in the middle", "", ""]


def test_the_ratios_in_a_line() -> None:
    assert nucleus_ratio_words(study_of(images()).cells) == (
        "nucleus to cytoplasm: DAPI 8, GFP 0.25 (mean of 3 cells, background as in the image)"
    )
    assert nucleus_ratio_words(study_of(None, "without").cells) == ""
    some = pd.DataFrame({"nucleus_to_cytoplasm_A": [1.0, np.nan], "nucleus_to_cytoplasm_B": [2.0, 3.0]})
    assert nucleus_ratio_words(some) == (
        "nucleus to cytoplasm: A 1 (1 cell), B 2.5 (2 cells) (means, background as in the image)"
    )


def test_the_shares_in_a_line() -> None:
    table = pd.DataFrame({"perinuclear_share_A": [0.5, 0.7, np.nan], "peripheral_share_A": [0.2, 0.1, 0.3]})
    assert nucleus_share_words(table.assign(nucleus_to_cytoplasm_A=1.0)) == (
        "cytoplasm's signal in its third at the nucleus and at the membrane: A 0.60 and 0.15 "
        "(an even one: 0.33)"
    )
    assert nucleus_share_words(study_of(None, "unmeasured").cells) == ""


def test_columns_are_explained_and_a_run_goes_on_with_them() -> None:
    study = study_of(images())
    columns = pd.read_csv(study.path / "columns.csv").set_index("column")
    assert "GFP" in columns.loc["nucleus_to_cytoplasm_GFP", "meaning"]
    again = study_of(images(), resume=True, csv=True)
    assert "nucleus_to_cytoplasm_GFP" in pd.read_csv(again.path / "cells.csv")


def test_damaged_numbers_of_a_channel_are_not_believed() -> None:
    study = study_of(images())
    table = pq.read_table(study.path / "cells.parquet")
    at = table.schema.get_field_index("nucleus_to_cytoplasm_GFP")
    table = table.set_column(at, table.schema.field(at), pa.array([1.0, np.inf, 1.0]))
    pq.write_table(table, study.path / "cells.parquet")
    with pytest.raises(ReadError, match="nucleus_to_cytoplasm_GFP"):
        cd.open_study(study.path)


def test_frames_of_a_movie_have_the_numbers_too() -> None:
    truth = cd.simulate.movie_with_nuclei("growing", frames=4, radius_px=18.0)
    brightness = np.array([30.0, 25.0, 20.0, 15.0])[:, None, None]
    signal = np.where(truth.nuclei, brightness, np.where(truth.masks, 10.0, 0.0)).astype(np.float32)
    for name, image in (
        ("m", truth.masks.astype(np.uint8)),
        ("n", truth.nuclei.astype(np.uint8)),
        ("s", signal),
    ):
        tifffile.imwrite(f"{name}.tif", image, metadata={"axes": "TYX"}, photometric="minisblack")
    given = {"nuclei": "n.tif", "signal": "s.tif", "channels": ("KTR",)}
    study = cd.run_movie("m.tif", "movie", **given, **GRID)  # type: ignore[arg-type]
    assert_allclose(study.cells["nucleus_to_cytoplasm_KTR"], [3.0, 2.5, 2.0, 1.5])
    assert_allclose(study.cells["nucleus_area"], 0.25 * truth.nuclei.sum(axis=(1, 2)))
    profile = study.nuclear_profile
    assert len(profile) == 4 * 8
    assert_allclose(profile.loc[profile["compartment"] == "cytoplasm", "mean"], 10.0)
    words = nucleus_ratio_words(study.cells, "frame")
    assert words == "nucleus to cytoplasm: KTR 2.25 (mean of 4 frames, background as in the image)"
