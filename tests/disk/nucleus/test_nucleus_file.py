"""Maps with a nucleus in files, in other processes, and in the image they were cut out of."""

import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.loading import load_map
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.errors import ReadError
from cytodisk.simulate import cell_with_nucleus


@pytest.fixture(scope="module")
def disk() -> DiskMap:
    cell = cell_with_nucleus("off centre", 1, shape="spread", radius_px=20.0)
    return map_to_disk(cell.mask, nucleus=cell.nucleus, edge_length=1.5)


def nucleus_of(disk: DiskMap) -> Nucleus:
    assert disk.nucleus is not None
    return disk.nucleus


def assert_same(one: DiskMap, other: DiskMap) -> None:
    """Both are one map, bit for bit."""
    for name in ("vertices_yx", "vertices_uv", "triangles", "boundary", "mask"):
        assert_array_equal(getattr(one, name), getattr(other, name))
    for name in ("places", "lifts", "inside", "boundary", "mask"):
        assert_array_equal(getattr(nucleus_of(one), name), getattr(nucleus_of(other), name))
    assert nucleus_of(one).report == nucleus_of(other).report
    assert one.nucleus_radius == other.nucleus_radius
    assert one.certificate == other.certificate
    pixels = np.argwhere(one.mask)
    assert_array_equal(one.to_disk(pixels), other.to_disk(pixels))


def test_a_map_comes_back_from_its_file(disk: DiskMap, tmp_path: Path) -> None:
    disk.save(tmp_path / "cell.npz")
    assert_same(load_map(tmp_path / "cell.npz"), disk)


def test_a_map_comes_back_from_another_process(disk: DiskMap) -> None:
    before = len(pickle.dumps(disk))
    assert_same(pickle.loads(pickle.dumps(disk)), disk)
    assert len(pickle.dumps(disk)) == before  # what was computed meanwhile is not sent


def test_a_map_in_the_image_its_mask_was_cut_out_of(disk: DiskMap, tmp_path: Path) -> None:
    corner, (height, width) = (7, 30), disk.mask.shape
    placed = disk.placed(corner, (height + 20, width + 50))
    assert placed.mask.shape == nucleus_of(placed).mask.shape == (height + 20, width + 50)
    assert_array_equal(nucleus_of(placed).mask[7 : 7 + height, 30 : 30 + width], nucleus_of(disk).mask)
    assert nucleus_of(placed).mask.sum() == nucleus_of(disk).mask.sum()
    assert placed.certificate.valid
    pixels = np.argwhere(disk.mask)
    np.testing.assert_allclose(placed.to_disk(pixels + corner), disk.to_disk(pixels), atol=1e-9)
    assert placed.nucleus_outline_yx is not None
    assert disk.nucleus_outline_yx is not None
    np.testing.assert_allclose(placed.nucleus_outline_yx, disk.nucleus_outline_yx + corner)
    placed.save(tmp_path / "cell.npz")
    assert_same(load_map(tmp_path / "cell.npz"), placed)


def test_maps_of_earlier_formats_have_no_nucleus(tmp_path: Path) -> None:
    plain = map_to_disk(cell_with_nucleus("centred", radius_px=20.0).mask, edge_length=1.5)
    plain.save(tmp_path / "cell.npz")
    arrays = dict(np.load(tmp_path / "cell.npz"))
    for earlier in (2, 3):
        header = json.loads(str(arrays["header"])) | {"format": earlier}
        np.savez(tmp_path / "earlier.npz", **arrays | {"header": np.array(json.dumps(header))})
        found = load_map(tmp_path / "earlier.npz")
        assert found.nucleus is None
        assert found.certificate.valid


def with_header(arrays: dict[str, Any], **changed: Any) -> dict[str, Any]:
    header = json.loads(str(arrays["header"]))
    header["nucleus"] |= changed
    return {**arrays, "header": np.array(json.dumps(header))}


DAMAGED: dict[str, tuple[Callable[[dict[str, Any]], dict[str, Any]], str]] = {
    "places missing": (
        lambda a: {name: array for name, array in a.items() if name != "nucleus_places"},
        "nucleus_places is missing",
    ),
    "places not finite": (lambda a: {**a, "nucleus_places": a["nucleus_places"] * np.nan}, "nucleus_places"),
    "places short": (lambda a: {**a, "nucleus_places": a["nucleus_places"][:-1]}, "nucleus_places has shape"),
    "outline backwards": (lambda a: {**a, "nucleus_boundary": a["nucleus_boundary"][::-1]}, "nucleus_places"),
    "outline of two": (lambda a: {**a, "nucleus_boundary": a["nucleus_boundary"][:2]}, "nucleus_boundary"),
    "outline of none": (
        lambda a: {**a, "nucleus_boundary": a["nucleus_boundary"] + 10**6},
        "nucleus_boundary",
    ),
    "wound up": (lambda a: {**a, "nucleus_lifts": a["nucleus_lifts"] + 900}, "nucleus_lifts"),
    "no nucleus": (lambda a: {**a, "nucleus_inside": a["nucleus_inside"] & False}, "cytoplasm and nucleus"),
    "no cytoplasm": (lambda a: {**a, "nucleus_inside": a["nucleus_inside"] | True}, "cytoplasm and nucleus"),
    "empty mask": (lambda a: {**a, "nucleus_mask": a["nucleus_mask"] & False}, "not part of the cell's"),
    "mask elsewhere": (lambda a: with_header(a, corner=[0, 0]), "does not lie in the cell's"),
    "no radius": (lambda a: with_header(a, radius=0.0), "radius"),
    "radius of the cell": (lambda a: with_header(a, radius=1.0), "radius"),
    "a report of nothing": (lambda a: with_header(a, report={}), "report"),
}


@pytest.mark.parametrize("what", DAMAGED)
def test_a_damaged_file_is_refused(what: str, disk: DiskMap, tmp_path: Path) -> None:
    disk.save(tmp_path / "cell.npz")
    damaging, words = DAMAGED[what]
    np.savez(tmp_path / "damaged.npz", **damaging(dict(np.load(tmp_path / "cell.npz"))))
    with pytest.raises(ReadError, match=words) as caught:
        load_map(tmp_path / "damaged.npz")
    assert "damaged.npz" in str(caught.value)
    assert "make it again" in str(caught.value)


@pytest.mark.parametrize("name", ["nucleus_lifts", "nucleus_inside", "nucleus_places", "vertices_uv"])
def test_what_can_be_read_and_is_no_map_has_no_certificate(name: str, disk: DiskMap, tmp_path: Path) -> None:
    disk.save(tmp_path / "cell.npz")
    arrays, random = dict(np.load(tmp_path / "cell.npz")), np.random.default_rng(0)
    at = random.integers(arrays[name].size, size=40)
    outlines = np.concatenate([arrays["boundary"], arrays["nucleus_boundary"]])
    if name in ("nucleus_places", "vertices_uv"):
        at = 2 * np.setdiff1d(np.arange(len(arrays[name])), outlines)[:40]
    flat = arrays[name].reshape(-1)
    flat[at] = ~flat[at] if name == "nucleus_inside" else flat[at] + (1 if name == "nucleus_lifts" else 0.1)
    np.savez(tmp_path / "damaged.npz", **arrays)
    found = load_map(tmp_path / "damaged.npz")
    assert not found.certificate.valid
    pixels = np.argwhere(found.mask)
    assert found.to_disk(pixels).shape == found.to_cell(pixels / 1000.0).shape == pixels.shape
    assert np.isfinite(found.distortion.area)
