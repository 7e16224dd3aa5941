"""Layers that are open become the files that a command reads."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile

import cytodisk as cd
from cytodisk.errors import MaskError, ReadError, SignalError
from cytodisk.images.frames import open_frames
from cytodisk.images.spots.spots import branches
from cytodisk.images.spots.track_files import read_tracks
from cytodisk.napari.given.chosen_layers import ChosenLayers
from cytodisk.napari.given.given_layers import given_files

pytestmark = pytest.mark.slow
layers = pytest.importorskip("napari.layers")

MICROMETRES = {"scale": (30.0, 0.2, 0.2), "units": ("second", "micrometer", "micrometer")}


@pytest.fixture(scope="module")
def stack() -> np.ndarray:
    return np.stack([np.pad(cd.simulate.disk(8), ((4, 5), (3 + k, 6 - k))) for k in range(3)]).astype(int)


@pytest.fixture(scope="module")
def signal(stack: np.ndarray) -> np.ndarray:
    return np.random.default_rng(0).normal(100, 5, stack.shape).astype(np.float32)


def given(folder: Path, masks: Any, *signal: Any, **more: Any) -> Any:
    values = more.pop("values", None)
    return given_files(ChosenLayers(masks, signal, **more), folder / "inputs", values)


def opened_from(layer: Any, path: Path) -> None:
    """Set the file that a reader would have told."""
    layer._source = layer.source.model_copy(update={"path": str(path)})


def test_layers_are_written_with_scale_and_names(
    tmp_path: Path, stack: np.ndarray, signal: np.ndarray
) -> None:
    labels = layers.Labels(stack, name="cells", **MICROMETRES)
    images = [layers.Image(signal + k, name=name, **MICROMETRES) for k, name in enumerate(("Rac1", "RhoA"))]

    found = given(tmp_path, labels, *images)

    masks, written = open_frames(found.masks), open_frames(found.signal)
    assert (masks.axes, masks.scale) == ("TYX", cd.Scale(0.2, 30.0))
    assert (written.axes, written.channels, written.scale) == ("TCYX", ("Rac1", "RhoA"), cd.Scale(0.2, 30.0))
    for number in range(3):
        np.testing.assert_array_equal(masks.frame(number)[0], stack[number])
        np.testing.assert_array_equal(written.frame(number), [signal[number], signal[number] + 1])
    assert found.scale == cd.Scale(0.2, 30.0)
    assert (found.values, found.notes) == ({}, ())
    assert found.written == (found.masks, found.signal)
    assert found.masks.name == "cells.ome.tif"


@pytest.mark.parametrize(
    ("unit", "size", "time", "interval"),
    [("nanometer", 200.0, "minute", 0.5), ("millimeter", 2e-4, "hour", 1 / 120), ("um", 0.2, "ms", 30_000.0)],
)
def test_units_become_micrometres_and_seconds(
    tmp_path: Path, stack: np.ndarray, unit: str, size: float, time: str, interval: float
) -> None:
    labels = layers.Labels(stack, scale=(interval, size, size), units=(time, unit, unit))

    found = given(tmp_path, labels)

    assert found.scale.pixel_size_um == pytest.approx(0.2)
    assert found.scale.frame_interval_s == pytest.approx(30.0)


def test_a_scale_without_a_unit_is_unknown_and_said(tmp_path: Path, stack: np.ndarray) -> None:
    found = given(tmp_path, layers.Labels(stack, name="cells", scale=(1, 0.2, 0.2)))

    assert found.scale == cd.Scale()
    assert any("layer cells has the scale 0.2" in note and "--pixel-size 0.2" in note for note in found.notes)
    assert "pixel size: unknown, lengths are in px" in found.notes

    masks = layers.Labels(stack, name="cells")
    typed = given_files(ChosenLayers(masks), tmp_path / "typed", {"pixel_size_um": 0.2})
    assert not any("pixel size: unknown" in note for note in typed.notes)


def test_the_file_of_a_layer_is_used_while_it_holds_its_pixels(tmp_path: Path, stack: np.ndarray) -> None:
    path = tmp_path / "cells.ome.tif"
    metadata = {"axes": "TYX", "PhysicalSizeX": 0.2, "PhysicalSizeY": 0.2, "TimeIncrement": 30.0}
    tifffile.imwrite(path, stack.astype(np.uint8), metadata=metadata)
    labels = layers.Labels(stack.copy(), name="cells")
    opened_from(labels, path)

    same = given(tmp_path, labels)
    labels.data[1, 15, 15] = 0
    painted = given(tmp_path, labels)

    assert (same.masks, same.written) == (path, ())
    assert same.scale == painted.scale == cd.Scale(0.2, 30.0)
    assert painted.masks != path
    assert open_frames(painted.masks).frame(1)[0, 15, 15] == 0
    assert open_frames(painted.masks).scale == cd.Scale(0.2, 30.0)
    assert tifffile.imread(path)[1, 15, 15] == 1


def test_other_scale_than_that_of_the_file_comes_as_a_parameter(tmp_path: Path, stack: np.ndarray) -> None:
    path = tmp_path / "cells.ome.tif"
    tifffile.imwrite(
        path, stack.astype(np.uint8), metadata={"axes": "TYX", "PhysicalSizeX": 0.5, "PhysicalSizeY": 0.5}
    )
    labels = layers.Labels(stack, **MICROMETRES)
    opened_from(labels, path)

    found = given(tmp_path, labels)

    assert found.masks == path
    assert found.values == {"pixel_size_um": 0.2, "frame_interval_s": 30.0}
    assert any("which is used; its file cells.ome.tif says 0.5" in note for note in found.notes)


def test_what_cannot_be_used_is_refused_with_a_remedy(
    tmp_path: Path, stack: np.ndarray, signal: np.ndarray
) -> None:
    labels = layers.Labels(stack, name="cells")
    refused = [
        (MaskError, "points are no masks", layers.Points(np.zeros((1, 2)), name="spots"), ()),
        (ReadError, "not square: resample", layers.Labels(stack, scale=(1, 1, 2)), ()),
        (SignalError, "choose a layer of an image", labels, (labels,)),
        (ReadError, "Split RGB", labels, (layers.Image(np.zeros((9, 9, 3), np.uint8), rgb=True),)),
        (ReadError, "is moved .* set its translate", labels, (layers.Image(signal, translate=(0, 0, 2)),)),
        (
            ReadError,
            "is moved",
            layers.Labels(stack, scale=(1, 200, 200), units=("s", "nm", "nm"), translate=(0, 1, 1)),
            (layers.Image(signal, **MICROMETRES, translate=(0, 1, 1)),),
        ),
        (ReadError, "is mirrored", labels, (layers.Image(signal, scale=(1, -1, 1)),)),
        (ReadError, "another time", labels, (layers.Image(signal, translate=(1, 0, 0)),)),
        (
            ReadError,
            "has other pixels",
            layers.Labels(stack, **MICROMETRES),
            (layers.Image(signal, scale=(1, 2, 2)),),
        ),
        (ReadError, "is turned or sheared", labels, (layers.Image(signal, rotate=30),)),
        (SignalError, "layers of one shape", labels, (layers.Image(signal), layers.Image(signal[:2]))),
        (MaskError, "number its cells anew", layers.Labels(-stack), ()),
    ]
    for kind, words, masks, images in refused:
        with pytest.raises(kind, match=words):
            given(tmp_path, masks, *images)


def test_places_are_compared_in_pixels_whatever_the_unit(
    tmp_path: Path, stack: np.ndarray, signal: np.ndarray
) -> None:
    image = layers.Image(signal, scale=(60, 0.2, 0.2), units=("s", "um", "um"), translate=(60, 1, 2))
    labels = layers.Labels(stack, scale=(1, 200, 200), units=("min", "nm", "nm"), translate=(1, 1000, 2000))

    assert given(tmp_path, labels, image).scale == cd.Scale(0.2, 60.0)
    bare = layers.Labels(stack, translate=(1, 5, 10))
    assert given(tmp_path, bare, image).scale == cd.Scale(0.2, 60.0)


def test_a_z_stack_keeps_its_axes_and_the_library_refuses_it(tmp_path: Path, stack: np.ndarray) -> None:
    for told in ({"axis_labels": ("z", "y", "x")}, {"units": ("micrometer",) * 3}):
        found = given(tmp_path, layers.Labels(stack, **told))

        with pytest.raises(ReadError, match=r"is a z-stack .* --z max"):
            open_frames(found.masks)


def test_a_layer_of_a_z_stack_is_refused_as_its_file_is(tmp_path: Path, stack: np.ndarray) -> None:
    path = tmp_path / "deep.ome.tif"
    tifffile.imwrite(path, stack.astype(np.uint8), metadata={"axes": "ZYX"})
    labels = layers.Labels(stack)
    opened_from(labels, path)

    with pytest.raises(ReadError, match=r"z-stack.*--z max.*axis_labels, such as z, y, x"):
        given(tmp_path, labels)
    found = given(tmp_path, labels, values={"z": "max"})

    with tifffile.TiffFile(found.masks) as file:
        assert file.series[0].axes == "ZYX"


def test_an_unnamed_axis_stays_unnamed(tmp_path: Path, stack: np.ndarray) -> None:
    file = open_frames(given(tmp_path, layers.Labels(stack)).masks)

    assert (file.axes, file.said_by) == ("TYX", "nobody")


def test_shapes_are_the_outlines_of_cells(tmp_path: Path) -> None:
    image = layers.Image(np.zeros((30, 40), np.uint8), scale=(0.2, 0.2), units=("um", "um"))
    square = np.array([[2, 3], [2, 9], [8, 9], [8, 3.0]]) * 0.2
    ellipse = np.array([[12, 12], [12, 22], [26, 22], [26, 12.0]]) * 0.2
    line = np.array([[1, 1], [2, 2.0]])
    shapes = layers.Shapes([square, ellipse, line], shape_type=["polygon", "ellipse", "line"], name="cells")

    found = given(tmp_path, shapes, image)
    drawn = open_frames(found.masks).frame(0)[0]

    assert found.masks.suffix == ".geojson"
    assert (drawn == 1).sum() == pytest.approx(36, abs=13)
    assert drawn[5, 6] == 1
    assert drawn[19, 17] == 2
    assert drawn[12, 12] == 0
    assert any("left out: 3 (line)" in note for note in found.notes)
    assert found.scale == open_frames(found.signal).scale == cd.Scale(0.2)


def test_shapes_through_time_are_one_cell(tmp_path: Path, signal: np.ndarray) -> None:
    squares = [np.array([[k, 4, 4], [k, 4, 12], [k, 12, 12], [k, 12, 4.0]]) for k in range(3)]

    found = given(tmp_path, layers.Shapes(squares, shape_type="polygon"), layers.Image(signal))
    file = open_frames(found.masks)

    assert (file.axes, file.n_frames) == ("TYX", 3)
    assert [np.unique(file.frame(k)).tolist() for k in range(3)] == [[0, 1]] * 3


def test_tracks_keep_their_numbers_and_divisions(tmp_path: Path, stack: np.ndarray) -> None:
    rows = [[4, 0, 8, 9], [4, 1, 8, 9.5], [7, 2, 9, 4], [8, 2, 3, 5]]
    tracks = layers.Tracks(np.array(rows, dtype=float), graph={7: [4], 8: [4]})

    found = given(tmp_path, layers.Labels(stack), tracks=tracks)
    spots = read_tracks(found.tracks)
    cut = branches(spots)

    assert found.values["tracks"] == str(found.tracks)
    np.testing.assert_allclose(spots.yx, np.array(rows)[:, 2:])
    assert cut.track.tolist() == [4, 4, 7, 8]
    assert cut.mothers == {7: 4, 8: 4}


def test_lazy_arrays_are_read_frame_by_frame(tmp_path: Path, stack: np.ndarray) -> None:
    asked: list[tuple[Any, ...]] = []

    class Lazy:
        shape, dtype, ndim = stack.shape, stack.dtype, 3

        def __getitem__(self, index: Any) -> np.ndarray:
            asked.append(index)
            return np.asarray(stack[index])

        def __array__(self, *_: Any, **__: Any) -> np.ndarray:
            raise AssertionError("the whole array was read")

    labels = layers.Labels(stack)
    labels._data = Lazy()

    found = given(tmp_path, labels)

    assert {index[0] for index in asked} == {0, 1, 2}
    np.testing.assert_array_equal(tifffile.imread(found.masks), stack)


def test_the_highest_level_of_a_pyramid_is_taken(tmp_path: Path, stack: np.ndarray) -> None:
    labels = layers.Labels([stack[0], stack[0, ::2, ::2]], multiscale=True)

    np.testing.assert_array_equal(tifffile.imread(given(tmp_path, labels).masks), stack[0])


def test_work_ends_where_progress_says_so(tmp_path: Path, stack: np.ndarray) -> None:
    class StopHereError(Exception):
        pass

    def stop(done: int, of: int) -> None:
        assert (done, of) == (1, 3)
        raise StopHereError

    with pytest.raises(StopHereError):
        given_files(ChosenLayers(layers.Labels(stack)), tmp_path / "inputs", progress=stop)


def test_channels_of_one_file_are_used_from_it(tmp_path: Path, stack: np.ndarray) -> None:
    path = tmp_path / "image.ome.tif"
    channels = np.stack([stack + 10 * k for k in range(3)], axis=1).astype(np.uint16)
    tifffile.imwrite(path, channels, metadata={"axes": "TCYX", "Channel": {"Name": ["DAPI", "Rac1", "RhoA"]}})
    split = [layers.Image(channels[:, k], name=name) for k, name in ((2, "RhoA"), (1, "image [1]"))]
    whole = layers.Image(channels, name="image")
    for layer in (*split, whole):
        opened_from(layer, path)

    two, all_three = (
        given(tmp_path, layers.Labels(stack), *split),
        given(tmp_path, layers.Labels(stack), whole),
    )

    assert two.signal == all_three.signal == path
    assert two.values["signal_channels"] == ("2", "1")
    assert two.values["channels"] == ("RhoA", "image [1]")
    assert "channels" not in all_three.values
    assert "signal_channels" not in all_three.values
