import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.loading import load_map
from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import ParameterError, ReadError, SignalError, StudyError


@pytest.fixture(scope="module")
def disk() -> DiskMap:
    return map_to_disk(simulate.random_mask("spiky", 8))


def test_outside_the_cell_is_nan_or_the_nearest_boundary_point(disk: DiskMap) -> None:
    outside = np.array([[-50.0, -50.0], [-50.0, 200.0], [np.nan, 3.0]])
    assert np.isnan(disk.to_disk(outside)).all()
    nearest = disk.to_disk(outside, outside="nearest")
    np.testing.assert_allclose(np.hypot(*nearest[:2].T), 1.0)
    assert np.isnan(nearest[2]).all()
    corner = disk.outline_yx[np.square(disk.outline_yx - outside[0]).sum(axis=1).argmin()]
    np.testing.assert_allclose(nearest[0], disk.to_disk(corner), atol=1e-6)


def test_outside_the_disk_is_nan(disk: DiskMap) -> None:
    cell = disk.to_cell([[1.001, 0.0], [0.0, -2.0], [np.nan, 0.0], [0.3, 0.2]])
    assert np.isnan(cell[:3]).all()
    assert np.isfinite(cell[3]).all()


def test_the_whole_round_disk_is_covered(disk: DiskMap) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 5000)
    for radius in (1.0 - 1e-9, 0.999, 0.5, 0.0):
        uv = radius * np.column_stack([np.cos(angle), np.sin(angle)])
        back = disk.to_disk(disk.to_cell(uv))
        np.testing.assert_allclose(back, uv, atol=1e-8)


def test_boundary_vertices_go_to_their_place_on_the_circle(disk: DiskMap) -> None:
    circle = disk.vertices_uv[disk.boundary]
    np.testing.assert_allclose(disk.to_disk(disk.outline_yx, outside="nearest"), circle, atol=1e-7)
    assert (np.diff(disk.boundary_angles) > 0).all()


def test_points_of_any_shape_keep_it(disk: DiskMap) -> None:
    inside = np.argwhere(disk.mask)[:6].astype(float)
    assert disk.to_disk(inside[0]).shape == (2,)
    stacked = disk.to_disk(inside.reshape(2, 3, 2))
    np.testing.assert_array_equal(stacked.reshape(6, 2), disk.to_disk(inside))
    assert disk.to_disk(np.empty((0, 2))).shape == (0, 2)


def test_bad_points_are_refused(disk: DiskMap) -> None:
    with pytest.raises(ParameterError, match=r"points_yx.*\(4, 3\)"):
        disk.to_disk(np.zeros((4, 3)))
    with pytest.raises(ParameterError, match="points_uv must have 2"):
        disk.to_cell(1.0)
    with pytest.raises(ParameterError, match=r"outside.*'zero'"):
        disk.to_disk([[0.0, 0.0]], outside="zero")


def test_image_shows_the_signal_where_the_map_says(disk: DiskMap) -> None:
    column = simulate.linear_signal(disk.mask.shape, (0.0, 1.0))
    image = disk.image(column, size=101)
    assert image.shape == (101, 101)
    axis = (np.arange(101) + 0.5) / 101 * 2.0 - 1.0
    v, u = np.meshgrid(axis, axis, indexing="ij")
    np.testing.assert_array_equal(np.isfinite(image), np.hypot(u, v) <= 1.0)
    inside = np.isfinite(image)
    expected = np.clip(disk.to_cell(np.stack([u, v], axis=-1)[inside])[:, 1], 0, disk.mask.shape[1] - 1)
    np.testing.assert_allclose(image[inside], expected, atol=1e-9)


def test_bad_images_are_refused(disk: DiskMap) -> None:
    with pytest.raises(SignalError, match=r"signal has shape \(3, 3\), the mask"):
        disk.image(np.zeros((3, 3)))
    with pytest.raises(SignalError, match=r"signal.*dtype complex128"):
        disk.image(np.zeros(disk.mask.shape, dtype=complex))
    with pytest.raises(ParameterError, match=r"size.*0"):
        disk.image(np.zeros(disk.mask.shape), size=0)


def test_a_map_comes_back_from_its_file(tmp_path: Path) -> None:
    disk = map_to_disk(simulate.random_mask("comb", 1), edge_length=2.0)
    disk.save(tmp_path / "a.npz")
    read = load_map(tmp_path / "a.npz")
    for name in ("vertices_yx", "vertices_uv", "triangles", "boundary", "mask"):
        np.testing.assert_array_equal(getattr(read, name), getattr(disk, name))
    for name in ("report", "method", "start", "shape_weight", "edge_length", "steps", "converged"):
        assert getattr(read, name) == getattr(disk, name)
    assert read.certificate == disk.certificate
    assert [path.name for path in tmp_path.iterdir()] == ["a.npz"]
    assert json.loads(str(np.load(tmp_path / "a.npz")["header"]))["format"] == 4


def test_saving_into_a_missing_folder_is_refused(disk: DiskMap, tmp_path: Path) -> None:
    with pytest.raises(StudyError, match="cannot write"):
        disk.save(tmp_path / "absent" / "a.npz")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"b\.npz does not exist"):
        load_map(tmp_path / "b.npz")


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 0.999])
def test_a_cut_off_file_is_refused(disk: DiskMap, tmp_path: Path, share: float) -> None:
    path = tmp_path / "a.npz"
    disk.save(path)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(ReadError, match=r"is not a map that DiskMap\.save wrote"):
        load_map(path)


def test_a_damaged_file_is_refused(disk: DiskMap, tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    disk.save(path)
    damaged = bytearray(path.read_bytes())
    damaged[len(damaged) // 2 : len(damaged) // 2 + 40] = bytes(40)
    path.write_bytes(bytes(damaged))
    with pytest.raises(ReadError):
        load_map(path)


@pytest.mark.parametrize(
    "content", [b"not a zip", b"\x93NUMPY", b"PK\x03\x04garbage"], ids=["text", "npy", "zip"]
)
def test_another_file_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(content)
    with pytest.raises(ReadError):
        load_map(path)


def test_a_file_that_is_no_archive_is_refused_in_our_own_words(tmp_path: Path) -> None:
    (tmp_path / "a.tif").write_bytes(b"II*" + bytes(100))
    np.save(tmp_path / "a.npy", np.zeros(3))
    for name in ("a.tif", "a.npy"):
        with pytest.raises(ReadError, match=rf"{name}.*DiskMap\.save"):
            load_map(tmp_path / name)


def test_another_array_file_and_another_format_are_refused(disk: DiskMap, tmp_path: Path) -> None:
    other = tmp_path / "other.npz"
    np.savez(other, a=np.zeros(3))
    with pytest.raises(ReadError):
        load_map(other)
    np.save(tmp_path / "plain.npy", np.zeros(3))
    with pytest.raises(ReadError):
        load_map(tmp_path / "plain.npy")
    np.savez(other, header=np.array(json.dumps({"format": 99})))
    with pytest.raises(ReadError, match=r"format 99.*formats 2 to 4.*cytodisk map"):
        load_map(other)
    np.savez(other, header=np.array(json.dumps([1])))
    with pytest.raises(ReadError):
        load_map(other)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"corner": [500, 500]}, "is not in an image"),
        ({"corner": [-1, 0]}, r"header: corner\.0 must be .* 0, got -1"),
        ({"image_shape": [2, 2]}, "is not in an image"),
        ({"image_shape": [10**12, 10**12]}, r"image_shape\.0 must be .* 1000000, got 1000000000000"),
        ({"steps": "many"}, r"header: steps must be .*integer, got 'many'"),
        ({"pixel_size_um": -1.0}, r"header: pixel_size_um\S* must be greater than 0, got -1\.0"),
        ({"shape_weight": float("nan")}, r"header: shape_weight must be a finite number, got nan"),
        ({"report": []}, r"header: report must be .*, got \[\]"),
        ({"mask": np.zeros((60, 60), dtype=bool)}, "mask is not that of the cell"),
        ({"mask": np.full((3, 3), 0.5)}, "mask has dtype float64"),
        ({"mask": np.ones((2, 2, 2), dtype=bool)}, r"mask has shape \(2, 2, 2\)"),
        ({"mask": np.ones((9000, 9000), dtype=bool)}, r"mask has shape \(9000, 9000\), where at most"),
        ({"vertices_uv": np.zeros((5, 2))}, "vertices_uv has shape"),
        ({"vertices_yx": np.full((5, 2), np.nan)}, "vertices_yx has nan"),
        ({"vertices_yx": np.full((5, 2), 1e300)}, r"vertices_yx has 1e\+300"),
        ({"triangles": np.zeros((4, 3))}, "triangles has dtype float64, not whole numbers"),
        ({"triangles": np.full((4, 3), 10**6)}, "triangles has 1000000"),
        ({"triangles": np.full((4, 3), 2**63, dtype=np.uint64)}, "triangles has 9223372036854775808"),
        ({"boundary": np.array([-1, 0, 1])}, "boundary has -1"),
        ({"boundary": np.empty(0, dtype=int)}, "boundary has 0 vertices"),
        ({"boundary": np.array([0, 0, 0, 0])}, "boundary does not run once around the disk"),
        ({"triangles": np.array([[0, 1, 2]])}, "triangles has 1 rows, which do not fill a disk"),
        ({"triangles": np.array([[0, 1, 2]] * 4)}, "triangles has 4 rows, which do not fill a disk"),
    ],
)
def test_arrays_that_do_not_fit_each_other_are_refused(
    disk: DiskMap, tmp_path: Path, change: dict[str, Any], message: str
) -> None:
    disk.save(tmp_path / "a.npz")
    with np.load(tmp_path / "a.npz") as file:
        arrays = dict(file)
    header = json.loads(str(arrays["header"]))
    header |= {name: change.pop(name) for name in [*change] if name in header}
    np.savez(tmp_path / "b.npz", **(arrays | change | {"header": np.array(json.dumps(header))}))
    with pytest.raises(ReadError, match=message):
        load_map(tmp_path / "b.npz")
