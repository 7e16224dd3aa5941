import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import tifffile
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.errors import ParameterError, ReadError, SignalError, StudyError
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.map.checked_cells import check_cells
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.map.map_study import map_study

SMALL = MapParameters(layers=3, sectors=8, edge_length=2.0)
PER_IMAGE = (11, 3, 5)  # cells; the first image has more of them than go into one part


class Stopped(Exception):
    """What stands for a kill."""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of label images, and beside it a folder of images with two channels."""
    place = tmp_path_factory.mktemp("written")
    (place / "masks").mkdir()
    (place / "images").mkdir()
    for number, cells in enumerate(PER_IMAGE):
        labels = cd.simulate.label_image(cells, number)
        counts = np.random.default_rng(number).integers(0, 4000, (2, *labels.shape)).astype(np.uint16)
        tifffile.imwrite(place / "masks" / f"im{number + 9}_cp_masks.tif", labels, compression="zlib")
        names = {"axes": "CYX", "Channel": {"Name": ["Rac1", "RhoA"]}}
        tifffile.imwrite(place / "images" / f"im{number + 9}.ome.tif", counts, metadata=names)
    return place


@pytest.fixture
def place(written: Path, tmp_path: Path) -> Path:
    """A copy to change."""
    shutil.copytree(written, tmp_path / "in")
    return tmp_path / "in"


def assert_same_study(first: cd.Study, second: cd.Study) -> None:
    pd.testing.assert_frame_equal(
        first.cells.drop(columns="seconds"), second.cells.drop(columns="seconds"), check_exact=True
    )
    tables = [(study.path / "windows.parquet").read_bytes() for study in (first, second)]
    assert tables[0] == tables[1]


@pytest.fixture(scope="module")
def whole(written: Path, tmp_path_factory: pytest.TempPathFactory) -> cd.Study:
    inputs = open_inputs(written / "masks", written / "images", SMALL)
    return map_study(inputs, tmp_path_factory.mktemp("whole") / "out")


def test_every_cell_of_every_file_has_its_row(whole: cd.Study) -> None:
    cells = whole.cells
    assert cells["cell"].tolist() == list(range(sum(PER_IMAGE)))
    assert cells.groupby("source", sort=False).size().to_dict() == {
        f"im{number + 9}_cp_masks.tif": count for number, count in enumerate(PER_IMAGE)
    }
    assert cells["label"].tolist() == [label for count in PER_IMAGE for label in range(1, count + 1)]
    assert set(cells["status"]) == {"ok"}
    assert len(whole.windows) == sum(PER_IMAGE) * 2 * 3 * 8
    assert whole.provenance["inputs"]["masks"]["read as"] == "3 files: 3 label images"
    assert list(whole.provenance["inputs"]["signal"]["files"]) == [
        "im9.ome.tif",
        "im10.ome.tif",
        "im11.ome.tif",
    ]


def test_files_of_the_same_image_are_named_and_left_out(place: Path) -> None:
    labels = tifffile.imread(place / "masks" / "im9_cp_masks.tif")
    np.save(place / "masks" / "im9_seg.npy", {"masks": labels[::-1]}, allow_pickle=True)
    inputs = open_inputs(place / "masks", None, SMALL)
    assert len(list(check_cells(inputs))) == sum(PER_IMAGE)
    words = "3 files: 3 label images; 1 left out (as im9_seg.npy): another file has masks of the same image"
    assert inputs.understood == {"masks": words}


def test_cellposes_own_file_gives_what_the_label_image_gives(
    whole: cd.Study, place: Path, tmp_path: Path
) -> None:
    labels = tifffile.imread(place / "masks" / "im9_cp_masks.tif")
    np.save(tmp_path / "im9_seg.npy", {"masks": labels, "flows": [labels / 7]}, allow_pickle=True)
    inputs = open_inputs(tmp_path / "im9_seg.npy", place / "images" / "im9.ome.tif", SMALL)
    study = map_study(inputs, tmp_path / "out")
    columns = ["source", "seconds"]
    pd.testing.assert_frame_equal(
        study.cells.drop(columns=columns), whole.cells.head(PER_IMAGE[0]).drop(columns=columns)
    )


def test_cells_at_the_border_are_flagged(whole: cd.Study, written: Path) -> None:
    expected = []
    for path in sorted((written / "masks").iterdir(), key=lambda path: int(path.name[2:].split("_")[0])):
        labels = tifffile.imread(path)
        sides = set(np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]]).tolist())
        expected += [label in sides for label in range(1, labels.max() + 1)]
    assert any(expected)
    assert not all(expected)
    assert whole.cells["touches_border"].tolist() == expected
    assert ((whole.cells["border_share"] > 0) == expected).all()


def test_a_cell_cut_out_of_its_image_gives_what_the_whole_image_gives(whole: cd.Study, written: Path) -> None:
    labels = tifffile.imread(written / "masks" / "im9_cp_masks.tif")
    image = tifffile.imread(written / "images" / "im9.ome.tif")
    for cell in range(PER_IMAGE[0]):
        disk = cd.map_to_disk(labels == cell + 1, edge_length=2.0)
        windows = cd.polar_windows(3, 8).on(disk)
        data = cd.sample(windows, image)
        row = whole.cells.iloc[cell]
        assert (row["area_px"], row["vertices"]) == (disk.report.area_px, len(disk.vertices_yx))
        assert row["border_share"] == disk.report.border_share
        assert row["area_distortion"] == pytest.approx(disk.distortion.area, rel=1e-12)
        found = whole.windows[(whole.windows["cell"] == cell) & (whole.windows["channel"] == "RhoA")]
        for name in ("mean", "sd", "min", "max", "n_pixels"):
            assert_allclose(found[name], data[name][1].to_numpy().ravel(), rtol=1e-12)
        assert_allclose(found["centroid_y"], windows.centroids_yx[..., 0].ravel(), rtol=1e-12)
        assert_allclose(found["centroid_x"], windows.centroids_yx[..., 1].ravel(), rtol=1e-12)
        assert_allclose(found["eccentricity"], windows.eccentricities.ravel(), rtol=1e-9)
        kept = whole.map(cell)
        assert_array_equal(kept.mask, disk.mask)
        assert_allclose(kept.vertices_yx, disk.vertices_yx, atol=1e-12)
        assert_array_equal(kept.vertices_uv, disk.vertices_uv)
        assert_array_equal(kept.triangles, disk.triangles)
        assert kept.certificate.valid == disk.certificate.valid == row["certificate_valid"]


def test_a_point_to_align_to_is_one_of_the_image(written: Path, tmp_path: Path) -> None:
    path = written / "masks" / "im10_cp_masks.tif"
    parameters = SMALL.model_copy(update={"align": (40.0, 60.0)})
    study = map_study(open_inputs(path, None, parameters), tmp_path / "out")
    for cell in range(PER_IMAGE[1]):
        disk = cd.map_to_disk(tifffile.imread(path) == cell + 1, edge_length=2.0, align=(40.0, 60.0))
        assert_allclose(study.map(cell).vertices_uv, disk.vertices_uv, atol=1e-12)


def test_a_single_file_gives_what_it_gives_in_a_folder(
    whole: cd.Study, written: Path, tmp_path: Path
) -> None:
    paths = written / "masks" / "im9_cp_masks.tif", written / "images" / "im9.ome.tif"
    study = map_study(open_inputs(*paths, SMALL), tmp_path / "out")
    first = whole.cells.head(PER_IMAGE[0])
    columns = ["seconds"]
    pd.testing.assert_frame_equal(study.cells.drop(columns=columns), first.drop(columns=columns))


@pytest.mark.parametrize("stop_after", [0, 8, 11])
def test_a_stopped_run_goes_on(whole: cd.Study, written: Path, tmp_path: Path, stop_after: int) -> None:
    inputs = open_inputs(written / "masks", written / "images", SMALL)

    def stop(done: int, total: int) -> None:
        if done == stop_after:
            raise Stopped

    with pytest.raises(Stopped):
        map_study(inputs, tmp_path / "out", progress=stop)
    calls: list[int] = []
    resumed = map_study(
        inputs, tmp_path / "out", resume=True, progress=lambda done, total: calls.append(done)
    )
    assert calls == [done for done in (0, 8, 11, 14, 19) if done >= stop_after]
    assert_same_study(whole, resumed)


def test_other_files_are_another_run(place: Path, tmp_path: Path) -> None:
    map_study(open_inputs(place / "masks", None, SMALL), tmp_path / "out")
    (place / "masks" / "im9_cp_masks.tif").rename(place / "masks" / "im8_cp_masks.tif")
    with pytest.raises(StudyError, match="masks sha256"):
        map_study(open_inputs(place / "masks", None, SMALL), tmp_path / "out", resume=True)


def test_a_damaged_file_costs_one_row(place: Path, whole: cd.Study, tmp_path: Path) -> None:
    content = (place / "masks" / "im10_cp_masks.tif").read_bytes()
    (place / "masks" / "im10_cp_masks.tif").write_bytes(content[: len(content) // 2])
    study = map_study(open_inputs(place / "masks", place / "images", SMALL), tmp_path / "out")
    assert study.cells["status"].tolist() == ["ok"] * 11 + ["unreadable"] + ["ok"] * 5
    assert study.cells["source"][11] == "im10_cp_masks.tif"
    assert study.provenance["warnings"][0].startswith("im10_cp_masks.tif: frame 0 cannot be read")
    last = whole.windows[whole.windows["cell"] >= 14]["mean"].to_numpy()
    assert_array_equal(study.windows[study.windows["cell"] >= 12]["mean"], last)


def test_masks_without_an_image_have_that_as_their_reason(place: Path, tmp_path: Path) -> None:
    (place / "images" / "im10.ome.tif").unlink()
    inputs = open_inputs(place / "masks", place / "images", SMALL)
    study = map_study(inputs, tmp_path / "out")
    lost = study.cells[study.cells["source"] == "im10_cp_masks.tif"]
    assert set(lost["status"]) == {"no image"}
    warning = f"cell {lost['cell'].iloc[0]} of im10_cp_masks.tif: has no image in"
    assert study.provenance["warnings"][0].startswith(warning)
    assert "im10_cp_masks.tif has no image in" in lost["reason"].iloc[0]
    assert set(study.cells.drop(lost.index)["status"]) == {"ok"}
    assert sum(bool(checked.reason) for checked in check_cells(inputs)) == len(lost) == PER_IMAGE[1]


def test_an_image_with_other_channels_is_refused(place: Path, tmp_path: Path) -> None:
    image = tifffile.imread(place / "images" / "im11.ome.tif")
    tifffile.imwrite(place / "images" / "im11.ome.tif", image[0])
    inputs = open_inputs(place / "masks", place / "images", SMALL)
    fault = str(inputs.signals["im11_cp_masks.tif"].fault)
    assert "has one channel without a name, im9.ome.tif and most others have Rac1, RhoA" in fault
    assert inputs.remarks == ("1 of 3 images have other channels than Rac1, RhoA: they are left out",)
    assert inputs.signals["im10_cp_masks.tif"].fault is None


def test_given_names_of_channels_count_for_every_image(written: Path) -> None:
    named = SMALL.model_copy(update={"channels": ("a", "b")})
    inputs = open_inputs(written / "masks", written / "images", named)
    assert {file.channels for file in inputs.signal_files} == {("a", "b")}
    wrong = SMALL.model_copy(update={"channels": ("a",)})
    with pytest.raises(ParameterError, match="has channels, which are 2"):
        open_inputs(written / "masks", written / "images", wrong)
    with pytest.raises(ParameterError, match="but there is no signal"):
        open_inputs(written / "masks", None, named)


def test_an_image_of_another_shape_is_refused(place: Path) -> None:
    image = tifffile.imread(place / "images" / "im11.ome.tif")
    names = {"axes": "CYX", "Channel": {"Name": ["Rac1", "RhoA"]}}
    tifffile.imwrite(place / "images" / "im11.ome.tif", image[:, 1:], metadata=names)
    fault = open_inputs(place / "masks", place / "images", SMALL).signals["im11_cp_masks.tif"].fault
    assert "they must have the same height and width" in str(fault)


def test_no_image_that_can_be_used_is_an_error(place: Path) -> None:
    for path in (place / "images").iterdir():
        path.write_text("no image")
    with pytest.raises(SignalError, match="no image can be used"):
        open_inputs(place / "masks", place / "images", SMALL)


def test_the_channels_that_most_images_have_decide(place: Path) -> None:
    image = tifffile.imread(place / "images" / "im9.ome.tif")
    tifffile.imwrite(place / "images" / "im9.ome.tif", image[0])  # the first one
    inputs = open_inputs(place / "masks", place / "images", SMALL)
    assert inputs.signals["im9_cp_masks.tif"].file is None
    assert [file.channels for file in inputs.signal_files] == [("Rac1", "RhoA")] * 2


def write_with_scale(path: Path, labels: np.ndarray, size: float) -> None:
    scale = {"axes": "YX", "PhysicalSizeX": size, "PhysicalSizeY": size}
    tifffile.imwrite(path.with_suffix(".ome.tif"), labels, metadata=scale)
    path.with_suffix(".ome.tif").rename(path)


def test_a_file_of_another_scale_costs_its_rows_alone(place: Path, tmp_path: Path) -> None:
    for number, size in ((9, 0.2), (10, 0.1), (11, 0.1005)):
        path = place / "masks" / f"im{number}_cp_masks.tif"
        write_with_scale(path, tifffile.imread(path), size)
    inputs = open_inputs(place / "masks", None, SMALL)
    assert inputs.scale.pixel_size_um == 0.1
    assert inputs.remarks == ("1 of 3 files have another pixel size than 0.1 µm: left out",)
    study = map_study(inputs, tmp_path / "out")
    assert study.cells["status"].tolist() == ["refused"] + ["ok"] * 8
    assert "has pixels of 0.2 µm, most files of the folder 0.1 µm: map it alone" in study.cells["reason"][0]
    assert study.provenance["warnings"][0] == inputs.remarks[0]
    given = open_inputs(place / "masks", None, SMALL.model_copy(update={"pixel_size_um": 0.3}))
    assert (given.scale.pixel_size_um, given.remarks, given.sources[0].fault) == (0.3, (), None)


def test_an_image_of_another_scale_costs_its_rows_alone(place: Path) -> None:
    for number, size in ((9, 0.1), (10, 0.1), (11, 0.2)):
        labels = tifffile.imread(place / "masks" / f"im{number}_cp_masks.tif")
        write_with_scale(place / "images" / f"im{number}.ome.tif", labels, size)
    inputs = open_inputs(place / "masks", place / "images", SMALL)
    assert inputs.scale.pixel_size_um == 0.1
    assert "has pixels of 0.2 µm" in str(inputs.signals["im11_cp_masks.tif"].fault)
    assert inputs.sources[2].fault is None


def test_files_without_a_scale_are_counted(place: Path) -> None:
    path = place / "masks" / "im10_cp_masks.tif"
    write_with_scale(path, tifffile.imread(path), 0.1)
    inputs = open_inputs(place / "masks", None, SMALL)
    assert inputs.scale.pixel_size_um == 0.1
    words = "2 of 3 files do not say their pixel size: 0.1 µm is taken for them"
    assert inputs.remarks == (words,)


def test_images_beside_plain_masks_are_not_mapped(place: Path) -> None:
    for number in (9, 10, 11):
        labels = tifffile.imread(place / "masks" / f"im{number}_cp_masks.tif")
        tifffile.imwrite(place / f"{number}.tif", labels)
        tifffile.imwrite(place / f"{number}_img.tif", labels * 3)
    for signal in ("_img", place / "_img"):
        inputs = open_inputs(place, signal, SMALL)
        assert [source.name for source in inputs.sources] == ["9.tif", "10.tif", "11.tif"]
        assert [file.path.name for file in inputs.signal_files] == ["9_img.tif", "10_img.tif", "11_img.tif"]


def test_a_file_that_stands_in_for_a_damaged_one_is_named(place: Path) -> None:
    path = place / "masks" / "im9_cp_masks.tif"
    np.save(place / "masks" / "im9_seg.npy", {"masks": tifffile.imread(path)}, allow_pickle=True)
    path.write_bytes(path.read_bytes()[:100])
    inputs = open_inputs(place / "masks", None, SMALL)
    assert inputs.remarks == ("im9_seg.npy is used: im9_cp_masks.tif cannot be",)
    assert len(list(check_cells(inputs))) == sum(PER_IMAGE)


def test_maps_can_be_left_out(whole: cd.Study, written: Path, tmp_path: Path) -> None:
    inputs = open_inputs(written / "masks", written / "images", SMALL)
    study = map_study(inputs, tmp_path / "out", maps=False)
    assert_same_study(whole, study)
    assert not list((tmp_path / "out" / "maps").iterdir())
    with pytest.raises(ReadError, match=r"cell 3 .*no map.*--no-maps"):
        study.map(3)


def test_figures_and_outlines_lie_in_the_image(whole: cd.Study, written: Path, tmp_path: Path) -> None:
    drawn: dict[str, tuple[tuple[int, ...], tuple[int, ...]]] = {}

    headings = []

    def draw(folder: Path, name: str, windows: cd.CellWindows, signal: object, heading: str) -> list[Path]:
        drawn[name] = windows.mask.shape, np.shape(signal)
        headings.append(heading)
        return []

    inputs = open_inputs(written / "masks", written / "images", SMALL)
    map_study(inputs, tmp_path / "out", draw=draw, draw_at_most=2, geojson=True)
    shape = tifffile.imread(written / "masks" / "im9_cp_masks.tif").shape
    assert drawn == {f"cell_{cell:05d}": (shape, (2, *shape)) for cell in range(2)}
    places = zip(range(2), whole.cells["source"], whole.cells["label"], strict=False)
    assert headings == [f"{source}, label {label} (cell {cell})" for cell, source, label in places]
    outlines = pd.read_json(tmp_path / "out" / "maps" / "cell_00005.geojson")["features"]
    x = [point[0] for feature in outlines for point in feature["geometry"]["coordinates"][0]]
    outline = whole.map(5).outline_yx
    assert (min(x), max(x)) == pytest.approx((outline[:, 1].min() + 0.5, outline[:, 1].max() + 0.5), abs=1e-3)


def test_a_pattern_stands_for_those_of_its_files_that_fit(place: Path, tmp_path: Path) -> None:
    inputs = open_inputs(place / "masks" / "im1*_cp_masks.tif", place / "images" / "*.ome.tif", SMALL)
    assert [source.name for source in inputs.sources] == ["im10_cp_masks.tif", "im11_cp_masks.tif"]
    assert [file.path.name for file in inputs.signal_files] == ["im10.ome.tif", "im11.ome.tif"]
    assert inputs.is_folder
    with pytest.raises(ReadError, match="fits files of 2 folders"):
        open_inputs(place / "*" / "im1*.tif", None, SMALL)
    with pytest.raises(ReadError, match="no file fits the pattern"):
        open_inputs(place / "masks" / "cell*.tif", None, SMALL)
