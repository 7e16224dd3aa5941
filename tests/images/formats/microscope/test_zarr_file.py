import json
import pickle
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr

from cytodisk.errors import ReadError
from cytodisk.images.contents import contents
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames, read_image

_UNITS = {"t": ("time", "second"), "c": ("channel", None), "z": ("space", "micrometer")}


def write_ome_zarr(
    path: Path,
    stack: np.ndarray,
    axes: str,
    *,
    version: str = "0.5",
    step: dict[str, float] | None = None,
    units: dict[str, str | None] | None = None,
    channels: tuple[str, ...] = (),
    chunks: tuple[int, ...] | None = None,
) -> Path:
    """An OME-Zarr image with one resolution."""
    described = []
    for axis in axes:
        kind, unit = _UNITS.get(axis, ("space", "micrometer"))
        unit = (units or {}).get(axis, unit)
        described.append({"name": axis, "type": kind} | ({"unit": unit} if unit else {}))
    scale = [float((step or {}).get(axis, 1.0)) for axis in axes]
    multiscale = {
        "axes": described,
        "datasets": [{"path": "0", "coordinateTransformations": [{"type": "scale", "scale": scale}]}],
    }
    ome: dict[str, Any] = {"multiscales": [multiscale]}
    if channels:
        ome["omero"] = {"channels": [{"label": name} for name in channels]}
    new = version == "0.5"
    attributes = (
        {"ome": {"version": version, **ome}}
        if new
        else {**ome, "multiscales": [{**multiscale, "version": version}]}
    )
    group = zarr.create_group(path, zarr_format=3 if new else 2, attributes=attributes)
    array = group.create_array("0", shape=stack.shape, dtype=stack.dtype, chunks=chunks or stack.shape)
    array[...] = stack
    return path


@pytest.fixture
def stack() -> np.ndarray:
    return np.random.default_rng(1).integers(0, 4000, (3, 2, 4, 20, 30), np.uint16)


@pytest.mark.parametrize("version", ["0.4", "0.5"])
def test_frames_channels_and_scale(tmp_path: Path, stack: np.ndarray, version: str) -> None:
    path = write_ome_zarr(
        tmp_path / "a.ome.zarr",
        stack[:, :, 0],
        "tcyx",
        version=version,
        step={"t": 5.0, "y": 0.16, "x": 0.16},
        channels=("GFP", "mCherry"),
    )
    file = pickle.loads(pickle.dumps(open_frames(path)))
    assert (file.axes, file.shape, file.channels) == ("TCYX", (3, 2, 20, 30), ("GFP", "mCherry"))
    assert (file.scale.pixel_size_um, file.scale.frame_interval_s, file.notes) == (0.16, 5.0, ())
    np.testing.assert_array_equal(file.frame(2), stack[2, :, 0])
    np.testing.assert_array_equal(read_image(path).values, stack[:, :, 0])


def test_slices_are_chosen_or_projected(tmp_path: Path, stack: np.ndarray) -> None:
    path = write_ome_zarr(tmp_path / "a.zarr", stack, "tczyx")
    with pytest.raises(ReadError, match=r"z-stack of 4 slices: pass one slice \(0 to 3\), as --z 2"):
        open_frames(path)
    np.testing.assert_array_equal(open_frames(path, choice=FileChoice(z="3")).frame(1), stack[1, :, 3])
    np.testing.assert_array_equal(
        open_frames(path, choice=FileChoice(z="max")).frame(1), stack[1].max(axis=1)
    )
    assert contents(path).lines == (
        "a.zarr: 3 frames, 4 slices in z, 2 channels without names, called a 1, a 2, 20 × 30 px of uint16, "
        "1 µm a pixel, 1 s a frame",
    )


def test_pieces_are_cut_out_of_a_frame(tmp_path: Path, stack: np.ndarray) -> None:
    path = write_ome_zarr(tmp_path / "a.zarr", stack, "tczyx", chunks=(1, 1, 1, 8, 8))
    file = open_frames(path, choice=FileChoice(z="1"))
    cut, rows = file.stored.by_piece(2) or pytest.fail("it has chunks")
    assert rows == 8
    np.testing.assert_array_equal(cut(slice(3, 12), slice(5, 30)), stack[2, :, 1, 3:12, 5:30])
    turned = write_ome_zarr(tmp_path / "b.zarr", np.swapaxes(stack[:, 0, 0], 1, 2).copy(), "txy")
    cut, _ = open_frames(turned).stored.by_piece(2) or pytest.fail("it has chunks")
    np.testing.assert_array_equal(cut(slice(3, 12), slice(5, 30))[0], stack[2, 0, 0, 3:12, 5:30])


def test_images_of_a_plate_a_conversion_and_labels_are_scenes(tmp_path: Path, stack: np.ndarray) -> None:
    image = stack[0, 0]
    zarr.create_group(tmp_path / "made.zarr", zarr_format=2, attributes={"bioformats2raw.layout": 3})
    for number in (0, 1, 10):
        write_ome_zarr(tmp_path / "made.zarr" / str(number), image + number, "zyx", version="0.4")
    made = contents(tmp_path / "made.zarr")
    assert [scene.name for scene in made.scenes] == ["0", "1", "10"]
    chosen = open_frames(made.path, choice=FileChoice(scene="10", z="0"))
    np.testing.assert_array_equal(chosen.frame(0)[0], image[0] + 10)

    zarr.create_group(
        tmp_path / "plate.zarr", attributes={"ome": {"plate": {"wells": [{"path": "A/1"}, {"path": "B/2"}]}}}
    )
    for well in ("A/1", "B/2"):
        zarr.create_group(
            tmp_path / "plate.zarr" / well, attributes={"ome": {"well": {"images": [{"path": "0"}]}}}
        )
        write_ome_zarr(tmp_path / "plate.zarr" / well / "0", image[0], "yx")
    with pytest.raises(ReadError, match=r"2 scenes: .* are 0 \(A/1/0\), 1 \(B/2/0\)"):
        open_frames(tmp_path / "plate.zarr")
    assert open_frames(tmp_path / "plate.zarr", choice=FileChoice(scene="B/2/0")).shape == (20, 30)

    zarr.create_group(tmp_path / "labels", attributes={"ome": {"labels": ["cells"]}})
    write_ome_zarr(tmp_path / "labels" / "cells", image[0], "yx")
    np.testing.assert_array_equal(open_frames(tmp_path / "labels").frame(0)[0], image[0])


def test_of_a_plate_the_image_that_is_taken_is_opened_alone(tmp_path: Path, stack: np.ndarray) -> None:
    plate = tmp_path / "plate.zarr"
    wells = [{"path": f"A/{column}"} for column in range(60)]
    zarr.create_group(plate, attributes={"ome": {"plate": {"wells": wells}}})
    for well in wells:
        attributes = {"ome": {"well": {"images": [{"path": "0"}]}}}
        zarr.create_group(plate / well["path"], attributes=attributes)
        if well["path"] != "A/7":
            (plate / well["path"] / "0").mkdir()  # what is not taken may be anything
    write_ome_zarr(plate / "A" / "7" / "0", stack[0, 0, 0], "yx")
    np.testing.assert_array_equal(
        open_frames(plate, choice=FileChoice(scene="7")).frame(0)[0], stack[0, 0, 0]
    )
    with pytest.raises(ReadError, match=r"60 scenes: .* 11 \(A/11/0\) and 48 more"):
        open_frames(plate)
    with pytest.raises(ReadError, match="A/8/0"):
        open_frames(plate, choice=FileChoice(scene="A/8/0"))


@pytest.mark.parametrize(
    ("step", "units", "size", "interval", "said"),
    [
        ({"y": 160.0, "x": 160.0}, {"y": "nanometer", "x": "nanometer"}, 0.16, 1.0, ""),
        ({"t": 2.0}, {"t": "minute"}, 1.0, 120.0, ""),
        ({"t": 2.0}, {"t": None}, 1.0, None, "frame interval of 2 has no unit.*--frame-interval"),
        (
            {"y": 0.2, "x": 0.2},
            {"y": None, "x": None},
            None,
            1.0,
            "pixel size of 0.2 has no unit.*--pixel-size",
        ),
        ({}, {"y": None, "x": None, "t": None}, None, None, ""),
        ({}, {"y": "furlong", "x": "furlong"}, None, 1.0, "'furlong'.*--pixel-size"),
        ({"y": 0.0, "x": 0.0}, {}, None, 1.0, "makes no sense.*--pixel-size"),
    ],
)
def test_units_of_steps(
    tmp_path: Path,
    stack: np.ndarray,
    step: dict[str, float],
    units: dict[str, str | None],
    size: float | None,
    interval: float | None,
    said: str,
) -> None:
    file = open_frames(write_ome_zarr(tmp_path / "a.zarr", stack[:, 0, 0], "tyx", step=step, units=units))
    assert (file.scale.pixel_size_um, file.scale.frame_interval_s) == (size, interval)
    assert len(file.notes) == bool(said)
    if said:
        with pytest.raises(ValueError, match=said):
            raise ValueError(file.notes[0])


@pytest.mark.parametrize("scale", ["x", [1.0], ["a", 1.0], None, {}])
def test_a_damaged_scale_costs_the_scale_alone(tmp_path: Path, stack: np.ndarray, scale: Any) -> None:
    path = write_ome_zarr(tmp_path / "a.zarr", stack[0, 0, 0], "yx")
    group = zarr.open_group(path)
    ome = dict(group.attrs)["ome"]
    ome["multiscales"][0]["datasets"][0]["coordinateTransformations"][0]["scale"] = scale
    group.attrs["ome"] = ome
    file = open_frames(path)
    assert "coordinateTransformations cannot be used" in file.notes[0]
    assert "--pixel-size" in file.notes[0]
    np.testing.assert_array_equal(file.frame(0)[0], stack[0, 0, 0])


def test_other_zarr_folders_are_refused_with_what_to_pass(tmp_path: Path, stack: np.ndarray) -> None:
    array = zarr.create_array(tmp_path / "array.zarr", shape=(20, 30), dtype="u2")
    array[...] = 1
    with pytest.raises(ReadError, match="Zarr array without OME metadata: pass the folder above"):
        open_frames(tmp_path / "array.zarr")
    zarr.create_group(tmp_path / "group.zarr")
    with pytest.raises(ReadError, match="without an OME image"):
        open_frames(tmp_path / "group.zarr")
    path = write_ome_zarr(tmp_path / "axes.zarr", stack[:, 0], "aztx"[:2] + "yx")
    with pytest.raises(ReadError, match="has the axes azyx: save it with axes out of t, c, z, y and x"):
        open_frames(path)
    (tmp_path / "empty").mkdir()
    with pytest.raises(ReadError, match="is a folder"):
        open_frames(tmp_path / "empty")


def test_damaged_folders_end_in_a_read_error(tmp_path: Path, stack: np.ndarray) -> None:
    rng = np.random.default_rng(3)
    read = 0
    for trial in range(30):
        path = write_ome_zarr(
            tmp_path / f"{trial}.zarr", stack[:, 0, 0], "tyx", version=["0.4", "0.5"][trial % 2]
        )
        parts = sorted(part for part in path.rglob("*") if part.is_file())
        part = parts[trial % len(parts)]
        bad = bytearray(part.read_bytes())
        if trial % 3:
            bad = bad[: rng.integers(len(bad))]
        else:
            bad[rng.integers(len(bad))] = rng.integers(256)
        part.write_bytes(bytes(bad))
        with suppress(ReadError):
            open_frames(path).frame(0)
            read += 1
    assert 0 < read < 30  # and nothing but a ReadError came of the others


@pytest.mark.parametrize(
    ("axes", "field", "value", "said"),
    [
        ("yx", "shape", [10**9, 10**9], "memory"),
        ("tyx", "shape", [10**9, 20, 30], "claims 1000000000 planes and .* bytes are stored; copy it again"),
        ("yx", "chunks", [10**6, 10**6], "stored in chunks of 1000000 × 1000000"),
        ("yx", "shape", [-3, 30], "zarr"),
    ],
)
def test_claims_that_are_not_filled_are_refused(
    tmp_path: Path, stack: np.ndarray, axes: str, field: str, value: list[int], said: str
) -> None:
    path = write_ome_zarr(tmp_path / "a.zarr", stack[0, 0, 0] if axes == "yx" else stack[:, 0, 0], axes)
    place = path / "0" / "zarr.json"
    array = json.loads(place.read_text())
    if field == "shape":
        array["shape"] = value
    else:
        array["chunk_grid"]["configuration"]["chunk_shape"] = value
    place.write_text(json.dumps(array))
    with pytest.raises(ReadError, match=said):
        open_frames(path).frame(0)
