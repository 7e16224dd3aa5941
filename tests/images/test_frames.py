from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.errors import ParameterError, ReadError
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames

STACK = np.random.default_rng(0).integers(0, 4000, (3, 2, 20, 31)).astype(np.uint16)  # T, C, Y, X
PLANE = STACK[0, 0]


def frames_of(file: FrameFile) -> np.ndarray:
    return np.stack([file.frame(number) for number in range(file.n_frames)])


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "int32", "float32", "float64", "bool"])
def test_plain_tiff(tmp_path: Path, dtype: str) -> None:
    plane = PLANE.astype(dtype)
    tifffile.imwrite(tmp_path / "a.tif", plane)
    image = cd.read_image(tmp_path / "a.tif")
    assert image.dims == ("y", "x")
    assert image.dtype == plane.dtype
    assert_array_equal(image, plane)
    assert image.attrs == {"pixel_size_um": None, "frame_interval_s": None}


def test_an_unnamed_axis_is_what_the_caller_says(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", STACK[:, 0], photometric="minisblack")
    assert cd.read_image(tmp_path / "a.tif").dims == ("channel", "y", "x")
    movie = cd.read_image(tmp_path / "a.tif", unnamed="T")
    assert movie.dims == ("time", "y", "x")
    assert_array_equal(movie, STACK[:, 0])


def test_arguments_that_are_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="unnamed must be one of T, C, got '2'"):
        cd.read_image(tmp_path / "a.tif", unnamed="2")
    with pytest.raises(ParameterError, match="path must be a path, got NoneType"):
        cd.read_image(None)  # type: ignore[arg-type]


def test_ome_tiff_with_names_and_scale(tmp_path: Path) -> None:
    metadata = {
        "axes": "TCYX",
        "Channel": {"Name": ["Rac1", "RhoA"]},
        "PhysicalSizeX": 160.0,
        "PhysicalSizeXUnit": "nm",
        "PhysicalSizeY": 160.0,
        "PhysicalSizeYUnit": "nm",
        "TimeIncrement": 1300.0,
        "TimeIncrementUnit": "ms",
    }
    tifffile.imwrite(tmp_path / "a.ome.tif", STACK, metadata=metadata)
    image = cd.read_image(tmp_path / "a.ome.tif")
    assert image.dims == ("time", "channel", "y", "x")
    assert image["channel"].to_numpy().tolist() == ["Rac1", "RhoA"]
    assert image.attrs["pixel_size_um"] == pytest.approx(0.16)
    assert image.attrs["frame_interval_s"] == pytest.approx(1.3)
    assert_array_equal(image, STACK)


@pytest.mark.parametrize(("unit", "size"), [("µm", 0.2), ("mm", 0.0002), ("nm", 200.0), ("m", 2e-7)])
def test_ome_units_of_length(tmp_path: Path, unit: str, size: float) -> None:
    scale = {"PhysicalSizeX": size, "PhysicalSizeY": size}
    units = {"PhysicalSizeXUnit": unit, "PhysicalSizeYUnit": unit}
    tifffile.imwrite(tmp_path / "a.ome.tif", PLANE, metadata={"axes": "YX"} | scale | units)
    assert open_frames(tmp_path / "a.ome.tif").scale.pixel_size_um == pytest.approx(0.2)


def test_ome_without_a_unit_is_in_micrometres(tmp_path: Path) -> None:
    metadata = {"axes": "YX", "PhysicalSizeX": 0.3, "PhysicalSizeY": 0.3}
    tifffile.imwrite(tmp_path / "a.ome.tif", PLANE, metadata=metadata)
    assert open_frames(tmp_path / "a.ome.tif").scale.pixel_size_um == pytest.approx(0.3)


def test_an_unknown_unit_is_no_scale(tmp_path: Path) -> None:
    units = {"PhysicalSizeXUnit": "pixel", "PhysicalSizeYUnit": "pixel"}
    metadata = {"axes": "YX", "PhysicalSizeX": 1.0, "PhysicalSizeY": 1.0} | units
    tifffile.imwrite(tmp_path / "a.ome.tif", PLANE, metadata=metadata)
    assert open_frames(tmp_path / "a.ome.tif").scale.pixel_size_um is None


def test_channel_names_that_are_not_distinct_are_told_apart(tmp_path: Path) -> None:
    metadata = {"axes": "CYX", "Channel": {"Name": ["GFP", "GFP"]}}
    tifffile.imwrite(tmp_path / "a.ome.tif", STACK[0], metadata=metadata)
    assert open_frames(tmp_path / "a.ome.tif").channels == ("GFP", "GFP (2)")


@pytest.mark.parametrize("unit", ["micron", "um", "\\u00B5m"])
def test_imagej_tiff_with_scale(tmp_path: Path, unit: str) -> None:
    tifffile.imwrite(
        tmp_path / "a.tif",
        STACK,
        imagej=True,
        resolution=(5.0, 5.0),
        metadata={"axes": "TCYX", "unit": unit, "finterval": 2.5},
    )
    file = open_frames(tmp_path / "a.tif")
    assert (file.axes, file.n_frames, file.image_shape) == ("TCYX", 3, (20, 31))
    assert file.scale.pixel_size_um == pytest.approx(0.2)
    assert file.scale.frame_interval_s == pytest.approx(2.5)
    assert_array_equal(frames_of(file), STACK)


@pytest.mark.parametrize("axes", ["TCYX", "CTYX"])
@pytest.mark.parametrize("ome", [True, False])
def test_frames_come_in_order_of_time_whatever_the_order_of_axes(
    tmp_path: Path, axes: str, ome: bool
) -> None:
    path = tmp_path / ("a.ome.tif" if ome else "a.tif")
    stored = STACK if axes == "TCYX" else STACK.swapaxes(0, 1)
    tifffile.imwrite(path, stored, metadata={"axes": axes}, ome=ome, photometric="minisblack")
    assert_array_equal(frames_of(open_frames(path)), STACK)


def test_axes_of_length_1_are_left_out(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.ome.tif", PLANE[None, None, None], metadata={"axes": "TZCYX"})
    assert cd.read_image(tmp_path / "a.ome.tif").dims == ("y", "x")


@pytest.mark.parametrize("compression", ["lzw", "zlib", "deflate", "packbits"])
def test_compressed_tiff(tmp_path: Path, compression: str) -> None:
    tifffile.imwrite(tmp_path / "a.tif", STACK[:, 0], photometric="minisblack", compression=compression)
    assert_array_equal(cd.read_image(tmp_path / "a.tif"), STACK[:, 0])


def test_colour_tiff_has_channels(tmp_path: Path) -> None:
    colour = STACK[:, 0].astype(np.uint8).transpose(1, 2, 0)
    tifffile.imwrite(tmp_path / "a.tif", colour, photometric="rgb")
    image = cd.read_image(tmp_path / "a.tif")
    assert image.dims == ("channel", "y", "x")
    assert_array_equal(image, colour.transpose(2, 0, 1))


def test_grey_png(tmp_path: Path) -> None:
    imageio.imwrite(tmp_path / "a.png", PLANE.astype(np.uint8))
    image = cd.read_image(tmp_path / "a.png")
    assert image.dims == ("y", "x")
    assert_array_equal(image, PLANE.astype(np.uint8))


def test_colour_png_has_named_channels(tmp_path: Path) -> None:
    colour = STACK[:, 0].astype(np.uint8).transpose(1, 2, 0)
    imageio.imwrite(tmp_path / "a.png", colour)
    image = cd.read_image(tmp_path / "a.png")
    assert image["channel"].to_numpy().tolist() == ["red", "green", "blue"]
    assert_array_equal(image, colour.transpose(2, 0, 1))


def test_a_z_stack_is_refused(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.ome.tif", STACK[:, 0], metadata={"axes": "ZYX"})
    with pytest.raises(ReadError, match=r"z-stack.*project"):
        open_frames(tmp_path / "a.ome.tif")


def test_two_axes_of_one_kind_are_refused(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", STACK)
    with pytest.raises(ReadError, match=r"4 axes of sizes \(3, 2, 20, 31\).*axes TCYX"):
        open_frames(tmp_path / "a.tif")


def test_separate_images_in_one_file_are_refused(tmp_path: Path) -> None:
    with tifffile.TiffWriter(tmp_path / "a.tif") as writer:
        writer.write(PLANE)
        writer.write(PLANE[:10])
    with pytest.raises(ReadError, match="2 separate images"):
        open_frames(tmp_path / "a.tif")


def test_pixels_that_are_not_square_are_refused(tmp_path: Path) -> None:
    metadata = {"axes": "YX", "PhysicalSizeX": 0.2, "PhysicalSizeY": 0.3}
    tifffile.imwrite(tmp_path / "a.ome.tif", PLANE, metadata=metadata)
    with pytest.raises(ReadError, match=r"0\.2 × 0\.3 µm.*square pixels"):
        open_frames(tmp_path / "a.ome.tif")


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"gone\.tif does not exist: check the path"):
        open_frames(tmp_path / "gone.tif")


def test_a_folder_is_no_image(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="is a folder: pass one image file"):
        open_frames(tmp_path)


def test_an_unknown_format_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.vsi").write_bytes(b"II*")
    with pytest.raises(ReadError, match=r"a\.vsi.*TIFF"):
        open_frames(tmp_path / "a.vsi")


@pytest.mark.parametrize("name", ["a.tif", "a.png"])
@pytest.mark.parametrize("content", [b"", b"not an image", bytes(4096)])
def test_a_file_that_only_has_the_name_of_an_image(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ReadError, match="cannot be read as an image"):
        cd.read_image(tmp_path / name)


@pytest.mark.parametrize("kept", [0.1, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("kind", ["plain", "zlib", "ome", "imagej", "png"])
def test_a_truncated_file(tmp_path: Path, kind: str, kept: float) -> None:
    path = tmp_path / {"png": "a.png", "ome": "a.ome.tif"}.get(kind, "a.tif")
    if kind == "png":
        imageio.imwrite(path, PLANE.astype(np.uint8))
    else:
        options = {"zlib": {"compression": "zlib"}, "imagej": {"imagej": True}}.get(kind, {})
        tifffile.imwrite(path, STACK[:, 0], photometric="minisblack", **options)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(kept * len(whole))])
    with pytest.raises(ReadError, match=r"a\.\S+: .*(cannot be read as an image|is cut short)"):
        cd.read_image(path)


def test_a_damaged_frame_leaves_the_others(tmp_path: Path) -> None:
    path = tmp_path / "a.tif"
    tifffile.imwrite(path, STACK[:, 0], photometric="minisblack", compression="zlib")
    with tifffile.TiffFile(path) as tiff:
        page = tiff.pages[1]
        start, count = page.dataoffsets[0], page.databytecounts[0]
    with path.open("r+b") as file:
        file.seek(start)
        file.write(b"\xff" * count)
    damaged = open_frames(path)
    with pytest.raises(ReadError, match="frame 1 cannot be read as an image"):
        damaged.frame(1)
    assert_array_equal(damaged.frame(0)[0], STACK[0, 0])
    assert_array_equal(damaged.frame(2)[0], STACK[2, 0])


@pytest.mark.parametrize("compression", [None, "zlib"])
def test_pages_that_were_written_one_by_one_are_one_stack(tmp_path: Path, compression: str | None) -> None:
    with tifffile.TiffWriter(tmp_path / "a.tif") as writer:
        for plane in STACK[:, 0]:
            writer.write(plane, compression=compression)
    file = open_frames(tmp_path / "a.tif")
    assert (file.axes, file.said_by) == ("TYX", "nobody")
    assert "3 pages were written one by one" in file.evidence
    assert_array_equal(frames_of(file)[:, 0], STACK[:, 0])


def test_one_of_separate_images_is_chosen(tmp_path: Path) -> None:
    with tifffile.TiffWriter(tmp_path / "a.tif") as writer:
        writer.write(PLANE)
        writer.write(PLANE[:10])
    with pytest.raises(ReadError, match=r"--scene, of 0 \(20 × 31\), 1 \(10 × 31\)"):
        open_frames(tmp_path / "a.tif")
    file = open_frames(tmp_path / "a.tif", choice=FileChoice(scene="1"))
    assert_array_equal(file.frame(0)[0], PLANE[:10])
    with pytest.raises(ReadError, match="no scene '2'"):
        open_frames(tmp_path / "a.tif", choice=FileChoice(scene="2"))


@pytest.mark.parametrize(("unnamed", "axes"), [("T", "TYX"), ("C", "CYX")])
def test_planes_that_stand_first_are_what_the_caller_says(tmp_path: Path, unnamed: str, axes: str) -> None:
    planes = np.arange(3 * 12 * 10, dtype=np.uint16).reshape(3, 12, 10)
    tifffile.imwrite(tmp_path / "a.tif", planes, photometric="minisblack", planarconfig="separate")
    file = open_frames(tmp_path / "a.tif", unnamed=unnamed)
    assert file.axes == axes
    read = np.concatenate([file.frame(number) for number in range(file.n_frames)])
    np.testing.assert_array_equal(read, planes)


def test_the_greek_letter_is_a_micro_sign_too(tmp_path: Path) -> None:
    metadata = {"axes": "YX", "PhysicalSizeX": 0.2, "PhysicalSizeXUnit": "\u03bcm"}
    tifffile.imwrite(tmp_path / "a.ome.tif", PLANE, metadata=metadata)
    assert open_frames(tmp_path / "a.ome.tif").scale.pixel_size_um == pytest.approx(0.2)


def test_a_name_that_is_too_long_is_a_read_error(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="cannot be read"):
        open_frames(tmp_path / ("a" * 300 + ".tif"))


def test_a_file_that_was_replaced_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "movie.tif"
    for frames, value in ((3, 7), (3, 9), (5, 2)):
        tifffile.imwrite(path, np.full((frames, 6, 8), value, dtype=np.uint8), photometric="minisblack")
        found = open_frames(path)
        assert [int(found.frame(number).max()) for number in range(found.n_frames)] == [value] * frames


def test_threads_do_not_close_each_others_file(tmp_path: Path) -> None:
    path = tmp_path / "movie.tif"
    movie = np.arange(40, dtype=np.uint8).repeat(64 * 64).reshape(40, 64, 64)
    tifffile.imwrite(path, movie, photometric="minisblack", compression="zlib")
    found = open_frames(path)
    with ThreadPoolExecutor(8) as threads:
        read = list(threads.map(lambda number: int(found.frame(number % 40).max()), range(800)))
    assert read == list(range(40)) * 20


@pytest.mark.filterwarnings("ignore:.*reading array from closed file")
def test_a_file_beside_that_was_replaced_is_read_anew(tmp_path: Path) -> None:
    names = "urn:uuid:0a0a0a0a-0000-0000-0000-000000000000", "urn:uuid:0b0b0b0b-0000-0000-0000-000000000000"
    planes = "".join(
        f'<TiffData FirstT="{t}" IFD="0" PlaneCount="1"><UUID FileName="{t}.ome.tif">{name}</UUID></TiffData>'
        for t, name in enumerate(names)
    )

    def write(t: int, value: int, padding: str) -> None:
        xml = (
            '<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" '
            f'UUID="{names[t]}"><Image ID="Image:0"><Pixels ID="Pixels:0" DimensionOrder="XYZCT" '
            'Type="uint8" SizeX="16" SizeY="16" SizeZ="1" SizeC="1" SizeT="2">'
            f"{planes}</Pixels></Image></OME>"
        )
        pixels = np.full((16, 16), value, dtype=np.uint8)
        tifffile.imwrite(tmp_path / f"{t}.ome.tif", pixels, description=xml + padding, metadata=None)

    write(0, 3, "")
    write(1, 5, "")
    found = open_frames(tmp_path / "0.ome.tif")
    assert [int(found.frame(number).min()) for number in (1, 0, 1)] == [5, 3, 5]
    write(1, 7, " " * 500)
    assert int(found.frame(1).min()) == 7
