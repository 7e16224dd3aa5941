"""Only the pages of a frame are read, whatever the order of the axes; sets of files; slices."""

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

from cytodisk.errors import ReadError
from cytodisk.images import frame_pixels as module
from cytodisk.images.formats import tiff_segments
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frame_pixels import frame_pixels
from cytodisk.images.frames import open_frames

PIXELS = np.random.default_rng(5).integers(0, 999, (3, 2, 4, 24, 40)).astype(np.uint16)  # T, C, Z, Y, X
ORDERS = ["".join(order) for order in itertools.permutations("TCZ")]


def written(path: Path, order: str, **options: Any) -> Path:
    stored = PIXELS.transpose(["TCZ".index(axis) for axis in order] + [3, 4])
    tifffile.imwrite(path, stored, metadata={"axes": f"{order}YX"}, photometric="minisblack", **options)
    return path


@pytest.fixture
def decoded_pages(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """Numbers of the pages that tifffile decodes."""
    found: list[int] = []
    whole, piece = tifffile.TiffFile.asarray, tiff_segments.TiffSegments._decoded

    def asarray(tiff: Any, key: Any = None, **options: Any) -> Any:
        found.extend(key)
        return whole(tiff, key=key, **options)

    def decoded(segments: Any, tiff: Any, page: int, index: int) -> Any:
        found.append(page)
        return piece(segments, tiff, page, index)

    monkeypatch.setattr(tifffile.TiffFile, "asarray", asarray)
    monkeypatch.setattr(tiff_segments.TiffSegments, "_decoded", decoded)
    return found


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("options", [{}, {"compression": "zlib"}, {"compression": "lzw", "tile": (16, 16)}])
@pytest.mark.parametrize("whole", [True, False])
def test_a_frame_costs_its_own_pages(
    tmp_path: Path,
    order: str,
    options: dict[str, Any],
    whole: bool,
    decoded_pages: list[int],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "WHOLE_BYTES", 2**30 if whole else 0)
    file = open_frames(written(tmp_path / "a.ome.tif", order, **options), choice=FileChoice(z="1"))
    assert file.axes == "".join(axis for axis in order if axis != "Z") + "YX"
    for number in (2, 0):
        decoded_pages.clear()
        frame = frame_pixels(file, number)
        assert frame.is_whole == whole
        assert_array_equal(frame.cut(slice(3, 20), slice(5, 33)), PIXELS[number, :, 1, 3:20, 5:33])
        assert len(set(decoded_pages)) == (2 if options else 0)  # one page a channel, or none to decode


@pytest.mark.parametrize("options", [{}, {"compression": "zlib"}])
def test_slices_are_projected(tmp_path: Path, options: dict[str, Any]) -> None:
    path = written(tmp_path / "a.ome.tif", "TZC", **options)
    largest = open_frames(path, choice=FileChoice(z="max"))
    mean = open_frames(path, choice=FileChoice(z="mean"))
    assert (largest.dtype, mean.dtype) == (np.uint16, np.float32)
    for number in range(3):
        assert_array_equal(largest.frame(number), PIXELS[number].max(axis=1))
        np.testing.assert_allclose(mean.frame(number), PIXELS[number].mean(axis=1), rtol=1e-6)
        assert mean.frame(number).dtype == mean.dtype


def test_a_z_stack_says_what_to_pass(tmp_path: Path) -> None:
    path = written(tmp_path / "a.ome.tif", "TCZ")
    with pytest.raises(ReadError, match=r"is a z-stack .*--z max, or take one slice, as --z 2"):
        open_frames(path)
    with pytest.raises(ReadError, match=r"has no slice '4': pass one slice \(0 to 3\), as --z 2"):
        open_frames(path, choice=FileChoice(z="4"))


def test_slices_that_are_times(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", PIXELS[0, 0], imagej=True, metadata={"axes": "ZYX"})
    with pytest.raises(ReadError, match="if they are frames, pass --signal-axes TYX"):
        open_frames(tmp_path / "a.tif")
    file = open_frames(tmp_path / "a.tif", choice=FileChoice(axes="TYX"))
    assert_array_equal(file.frame(3)[0], PIXELS[0, 0, 3])


def test_slices_of_a_saved_array(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", PIXELS[:, 0])
    for z, wanted in (("2", PIXELS[:, 0, 2]), ("max", PIXELS[:, 0].max(axis=1))):
        file = open_frames(tmp_path / "a.npy", choice=FileChoice(axes="TZYX", z=z))
        assert file.axes == "TYX"
        assert_array_equal(np.concatenate([file.frame(number) for number in range(3)]), wanted)


SET = [f"part_{t}.ome.tif" for t in range(3)]


def write_set(folder: Path) -> None:
    uuids = [f"urn:uuid:00000000-0000-0000-0000-00000000000{t}" for t in range(3)]
    data = "".join(
        f'<TiffData FirstT="{t}" IFD="0" PlaneCount="1"><UUID FileName="{SET[t]}">{uuids[t]}</UUID>'
        "</TiffData>"
        for t in range(3)
    )
    for t, uuid in enumerate(uuids):
        xml = (
            f'<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" UUID="{uuid}"><Image ID="I:0">'
            '<Pixels ID="P:0" DimensionOrder="XYCZT" Type="uint16" SizeX="40" SizeY="24" SizeZ="1" SizeC="1" '
            f'SizeT="3" PhysicalSizeX="0.2">{data}</Pixels></Image></OME>'
        )
        tifffile.imwrite(folder / SET[t], PIXELS[t, 0, 0], description=xml, metadata=None, compression="zlib")


def frames_of(file: FrameFile) -> list[np.ndarray[Any, Any] | None]:
    found: list[np.ndarray[Any, Any] | None] = []
    for number in range(file.n_frames):
        try:
            found.append(file.frame(number)[0])
        except ReadError:
            found.append(None)
    return found


@pytest.mark.parametrize("whole", [True, False])
def test_a_set_of_files_is_one_movie(
    tmp_path: Path, whole: bool, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(module, "WHOLE_BYTES", 2**30 if whole else 0)
    write_set(tmp_path)
    for name in SET:
        file = open_frames(tmp_path / name)
        assert file.notes == ()
        for number in range(3):
            assert_array_equal(
                frame_pixels(file, number).cut(slice(0, 24), slice(0, 40))[0], PIXELS[number, 0, 0]
            )
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("lost", [0, 1, 2])
def test_missing_files_of_a_set_are_named(
    tmp_path: Path, lost: int, capfd: pytest.CaptureFixture[str]
) -> None:
    write_set(tmp_path)
    (tmp_path / SET[lost]).unlink()
    file = open_frames(tmp_path / SET[(lost + 1) % 3])
    assert file.n_frames == 3
    assert file.scale.pixel_size_um == pytest.approx(0.2)
    assert f"files of its set are missing ({SET[lost]})" in file.notes[0]
    for number, frame in enumerate(frames_of(file)):
        if number == lost:
            assert frame is None
        else:
            assert_array_equal(frame, PIXELS[number, 0, 0])
    assert capfd.readouterr().err == ""


def test_a_long_set_is_opened_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_set(tmp_path)
    file = open_frames(tmp_path / SET[0])
    file.frame(0)
    opened: list[Any] = []
    first = tifffile.TiffFile.__init__
    monkeypatch.setattr(
        tifffile.TiffFile,
        "__init__",
        lambda tiff, *given, **said: opened.append(1) or first(tiff, *given, **said),
    )
    for number in (1, 2, 0, 1):
        file.frame(number)
    assert not opened


def test_a_scene_whose_name_stands_twice_is_chosen_by_number(tmp_path: Path) -> None:
    path = tmp_path / "a.ome.tif"
    with tifffile.TiffWriter(path, ome=True) as writer:
        for number, name in enumerate(["cell", "cell", "field"]):
            image = np.full((20 + number, 30), number, np.uint8)
            writer.write(image, metadata={"axes": "YX", "Name": name}, photometric="minisblack")
    for chosen, value in (("1", 1), ("field", 2)):
        assert open_frames(path, choice=FileChoice(scene=chosen)).frame(0).max() == value
    with pytest.raises(ReadError, match=r"has no scene 'cell'.*0 .cell: 20 × 30.*1 .cell: 21 × 30"):
        open_frames(path, choice=FileChoice(scene="cell"))
