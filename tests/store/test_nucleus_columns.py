from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.runs.frame_rows import FramePlace, measure_windows
from cytodisk.runs.map.map_kind import MAP
from cytodisk.scale import Scale
from cytodisk.store.activity_reading import EDGE_VARIABLES
from cytodisk.store.activity_store import ActivityStore, open_activity
from cytodisk.store.provenance_file import MAPS
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.tables import schema
from cytodisk.store.window_columns import NUCLEUS_WINDOW_COLUMNS
from cytodisk.windows.polar_windows import CellWindows

NAMES = [column.name for column in NUCLEUS_WINDOW_COLUMNS]


def windows_with_nucleus() -> CellWindows:
    mask, nucleus = cd.simulate.random_pair(4)
    disk = cd.map_to_disk(mask, nucleus=nucleus, pixel_size_um=0.5)
    return cd.polar_windows(2, 3, nucleus_layers=1).on(disk)


def test_a_study_with_nuclei_reads_back_compartment_and_distance(tmp_path: Path) -> None:
    windows = windows_with_nucleus()
    row, columns = measure_windows(FramePlace(0, 0, 1, None, "mask.tif"), windows, None, "omit")
    provenance = {"fingerprint": {MAPS: MAPS_VERSION}, "length_unit": "µm"}
    folder = StudyFolder.start(tmp_path / "out", provenance, MAP.with_nuclei)
    folder.add(part_key(0), row | {"status": "ok"}, {"windows": columns}, [])
    folder.finish([part_key(0)])
    study = cd.open_study(tmp_path / "out")
    assert study.windows["compartment"].tolist() == ["cytoplasm"] * 6 + ["nucleus"] * 3
    expected = 0.5 * windows.depth_columns["nucleus_distance_p5"].ravel()
    assert_array_equal(study.windows["nucleus_distance_p5"], expected)
    assert study.windows.attrs["units"]["nucleus_distance"] == "µm"


def test_a_plain_cell_has_one_compartment_and_no_distance() -> None:
    windows = cd.polar_windows(2, 3).on(cd.map_to_disk(cd.simulate.disk(8)))
    _, columns = measure_windows(FramePlace(0, 0, 1), windows, None, "omit")
    table = pa.table(columns, schema=schema(MAP.with_nuclei.others["windows"], "px"))
    assert table.column("compartment").to_pylist() == ["cell"] * 6
    assert np.isnan(table.column("nucleus_distance").to_numpy()).all()
    plain = pa.table(columns, schema=schema(MAP.others["windows"], "px"))
    assert not set(NAMES) & set(plain.column_names)


def test_the_activity_of_a_movie_knows_compartments(tmp_path: Path) -> None:
    grid = cd.polar_windows(2, 3, nucleus_layers=1)
    names = ("area", "centroid_y", "centroid_x", "depth", "depth_p5", "depth_p95", *NAMES[1:])
    arrays: dict[str, Any] = {name: np.full((3, 3), float(k)) for k, name in enumerate(names)}
    arrays |= {name: np.zeros(3) for name in EDGE_VARIABLES}
    with ActivityStore.replacing(tmp_path / "a.zarr.zip") as store:
        cell = store.cell(0, 1, grid, (), Scale(0.5, None))
        for frame in range(70):  # more than a chunk
            cell.append(frame, arrays if frame % 2 else None, "ok" if frame % 2 else "no nucleus", "")
        cell.close()
    found = open_activity(tmp_path / "a.zarr.zip", 0)
    assert found["compartment"].to_numpy().tolist() == ["cytoplasm", "cytoplasm", "nucleus"]
    assert found["nucleus_distance"].dims == ("time", "layer", "sector")
    assert found["nucleus_distance_p95"].attrs["units"] == "µm"
    assert_array_equal(found["nucleus_distance"][1], np.full((3, 3), 6.0))
    assert found["nucleus_distance"][0].isnull().all()
