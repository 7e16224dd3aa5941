"""Metadata of TIFFs that are bad or contradict themselves: they cost the metadata, not the pixels."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frames import open_frames

MOVIE = np.random.default_rng(3).integers(0, 255, (4, 24, 32)).astype(np.uint8)
NAMESPACE = ' xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06"'
HEAD = '<?xml version="1.0" encoding="UTF-8"?>'
UNNAMED = "pages are taken as they stand"


def ome(
    said: str = "",
    inside: str = "<TiffData/>",
    *,
    sizes: tuple[Any, ...] = (32, 24, 1, 1, 4),
    namespace: str = NAMESPACE,
    name: str = "Rac1",
) -> str:
    along = " ".join(f'Size{axis}="{size}"' for axis, size in zip("XYZCT", sizes, strict=True))
    return (
        f'{HEAD}<OME{namespace}><Image ID="Image:0"><Pixels ID="P:0" DimensionOrder="XYCZT" Type="uint8" '
        f'{along} {said}><Channel ID="Channel:0:0" SamplesPerPixel="1" Name="{name}"/>{inside}'
        "</Pixels></Image></OME>"
    )


def planes(*times: float, unit: str = "s") -> str:
    return "<TiffData/>" + "".join(
        f'<Plane TheZ="0" TheC="0" TheT="{t}" DeltaT="{time}" DeltaTUnit="{unit}"/>'
        for t, time in enumerate(times)
    )


def opened(folder: Path, description: str, name: str = "m.ome.tif", **options: Any) -> FrameFile:
    """A movie with such a description; whatever that says, all of its pixels are read."""
    path = folder / name
    written = {"description": description.encode(), "metadata": None, "photometric": "minisblack"}
    tifffile.imwrite(path, MOVIE, **(written | options))
    file = open_frames(path)
    assert (file.axes, file.shape) == ("TYX", MOVIE.shape)
    assert_array_equal(np.concatenate([file.frame(number) for number in range(4)]), MOVIE)
    return file


def imagej(*lines: str) -> str:
    return "\n".join(["ImageJ=1.54f", "images=4", "frames=4", "hyperstack=true", *lines, "loop=false", ""])


def test_an_interval_that_the_planes_contradict_is_not_believed(tmp_path: Path) -> None:
    file = opened(
        tmp_path, ome('TimeIncrement="1" PhysicalSizeX="0.2" PhysicalSizeY="0.2"', planes(0, 5, 10, 15))
    )
    assert file.scale.frame_interval_s is None
    assert file.scale.pixel_size_um == pytest.approx(0.2)
    (note,) = file.notes
    assert "5 s apart" in note
    assert "1 s" in note
    assert "--frame-interval" in note


@pytest.mark.parametrize(
    ("said", "times", "unit", "interval"),
    [
        ("", (0, 5, 10, 15), "s", 5.0),
        ("", (0, 5000, 10000, 15000), "ms", 5.0),
        ('TimeIncrement="5" TimeIncrementUnit="Seconds"', (0, 5, 10, 15), "s", 5.0),
        ('TimeIncrement="0,5" TimeIncrementUnit="min"', (3, 33, 63, 93), "s", 30.0),
        ('TimeIncrement="5"', (0, 0, 0, 0), "s", 5.0),  # not timed
        ('TimeIncrement="5"', (0, 1, 2, 3), "fortnight", 5.0),
        ('TimeIncrement="5" TimeIncrementUnit="eons"', (0, 7, 14, 21), "s", 7.0),
    ],
)
def test_intervals_that_agree_or_stand_alone(
    tmp_path: Path, said: str, times: tuple[float, ...], unit: str, interval: float
) -> None:
    file = opened(tmp_path, ome(said, planes(*times, unit=unit)))
    assert file.scale.frame_interval_s == pytest.approx(interval)
    assert file.notes == ()


def test_frames_that_are_not_evenly_spaced_are_told(tmp_path: Path) -> None:
    file = opened(tmp_path, ome('TimeIncrement="5"', planes(0, 5, 60, 65)))
    assert file.scale.frame_interval_s is None
    assert "unevenly spaced" in file.notes[0]


@pytest.mark.parametrize("said", ['PhysicalSizeX="0.2 um"', 'PhysicalSizeX="2" PhysicalSizeXUnit="ell"'])
def test_a_size_that_cannot_be_read_is_named(tmp_path: Path, said: str) -> None:
    file = opened(tmp_path, ome(said))
    assert file.scale.pixel_size_um is None
    assert file.channels == ("Rac1",)
    assert "PhysicalSizeX is '2" in file.notes[0] or "PhysicalSizeX is '0.2 um'" in file.notes[0]
    assert "--pixel-size" in file.notes[0]


def test_resolution_tags_that_contradict_ome_are_told(tmp_path: Path) -> None:
    xml = ome('PhysicalSizeX="0.2" PhysicalSizeY="0.2"')
    per_cm = {"resolutionunit": "CENTIMETER"}
    agree = opened(tmp_path, xml, resolution=(50_000, 50_000), **per_cm)
    assert agree.scale.pixel_size_um == pytest.approx(0.2)
    assert agree.notes == ()
    printed = opened(tmp_path, xml, resolution=(72, 72), resolutionunit="INCH")
    assert printed.scale.pixel_size_um == pytest.approx(0.2)
    other = opened(tmp_path, xml, resolution=(10_000, 10_000), **per_cm)
    assert other.scale.pixel_size_um is None
    assert "say pixels of 0.2 µm, its resolution tags 1 µm" in other.notes[0]


def test_resolution_tags_alone_are_offered_but_not_believed(tmp_path: Path) -> None:
    options = {"resolutionunit": "CENTIMETER", "resolution": (50_000, 50_000)}
    file = opened(tmp_path, "", "m.tif", **options)
    assert file.scale.pixel_size_um is None
    assert file.notes[0].endswith("pass --pixel-size 0.2")
    assert opened(tmp_path, "", "m.tif", resolution=(300, 300), resolutionunit="INCH").notes == ()


@pytest.mark.parametrize("dpi", [72, 96, 300])
def test_dots_an_inch_are_no_scale(tmp_path: Path, dpi: int) -> None:
    file = opened(tmp_path, imagej("unit=inch"), "m.tif", resolution=(dpi, dpi))
    assert file.scale.pixel_size_um is None
    assert f"{dpi} dots an inch, a resolution for printing" in file.notes[0]


@pytest.mark.parametrize(
    ("unit", "per_unit", "size"),
    [
        ("Microns", 5, 0.2),
        ("micrometre", 5, 0.2),
        ("nm", 0.005, 0.2),
        ("mm", 5000, 0.2),
        ("inches", 127_000, 0.2),
    ],
)
def test_imagej_units_of_length(tmp_path: Path, unit: str, per_unit: float, size: float) -> None:
    file = opened(tmp_path, imagej(f"unit={unit}"), "m.tif", resolution=(per_unit, per_unit))
    assert file.scale.pixel_size_um == pytest.approx(size, rel=1e-4)
    assert file.notes == ()


@pytest.mark.parametrize(
    ("lines", "interval"),
    [
        (("finterval=2.0", "tunit=seconds"), 2.0),
        (("finterval=2", "tunit=Minutes"), 120.0),
        (("finterval=0,2", "tunit=hrs"), 720.0),
        (("finterval=20", "tunit=msec"), 0.02),
        (("finterval=20",), 20.0),
    ],
)
def test_imagej_units_of_time(tmp_path: Path, lines: tuple[str, ...], interval: float) -> None:
    file = opened(tmp_path, imagej(*lines), "m.tif")
    assert file.scale.frame_interval_s == pytest.approx(interval)


def test_an_imagej_unit_that_is_not_known_is_named(tmp_path: Path) -> None:
    file = opened(tmp_path, imagej("unit=ell", "finterval=2", "tunit=eon"), "m.tif", resolution=(5, 5))
    assert file.scale.attrs == {}
    assert "'ell'" in file.notes[0]
    assert "'eon'" in file.notes[1]


BROKEN = {
    "only names a companion": f'{HEAD}<OME{NAMESPACE}><BinaryOnly MetadataFile="x.companion.ome"/></OME>',
    "not well formed": ome().replace("<TiffData/>", "<TiffData>"),
    "no image": f"{HEAD}<OME{NAMESPACE}></OME>",
    "sizes in words": ome(sizes=(32, 24, 1, 1, "four")),
    "sizes below zero": ome(sizes=(32, 24, 1, 1, -4)),
    "wider than its pages": ome(sizes=(33, 24, 1, 1, 4)),
    "two thousand million wide": ome(sizes=(2**31, 24, 1, 1, 4)),
    "a thousand million frames": ome(sizes=(32, 24, 1, 1, 10**9)),
    "fewer frames than pages": ome(sizes=(32, 24, 1, 1, 2)),
}


@pytest.mark.parametrize("fault", BROKEN)
@pytest.mark.parametrize("compression", [None, "zlib"])
def test_ome_metadata_that_cannot_be_used_leave_the_pixels(
    tmp_path: Path, fault: str, compression: str | None, capfd: pytest.CaptureFixture[str]
) -> None:
    file = opened(tmp_path, BROKEN[fault], compression=compression)
    assert file.said_by == "nobody"
    assert any(UNNAMED in note for note in file.notes)
    assert "()" not in " ".join(file.notes)
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("xml", [ome(name="R&D"), ome(namespace=""), ome(name="R&D", namespace="")])
def test_ome_metadata_that_can_be_mended_are_read(tmp_path: Path, xml: str) -> None:
    file = opened(tmp_path, xml.replace('XYCZT"', 'XYCZT" PhysicalSizeX="0.2" PhysicalSizeY="0.2"'))
    assert file.scale.pixel_size_um == pytest.approx(0.2)
    assert file.said_by == "file"
    assert file.notes == ()


def test_a_companion_file_that_is_there_is_read(tmp_path: Path) -> None:
    (tmp_path / "x.companion.ome").write_text(ome('PhysicalSizeX="0.3" TimeIncrement="4"'))
    file = opened(tmp_path, BROKEN["only names a companion"])
    assert file.scale.attrs == {"pixel_size_um": pytest.approx(0.3), "frame_interval_s": pytest.approx(4)}
    assert file.channels == ("Rac1",)


@pytest.mark.parametrize("compression", [None, "zlib"])
@pytest.mark.parametrize(
    "description",
    [
        '{"shape": [1000000000, 24, 32]}',
        '{"shape": [5, 24, 32], "axes": "TYX"}',
        '{"shape": [4, 24, 33]}',
        '{"shape": [4, 24',
        imagej().replace("=4", "=1000000000"),
        imagej().replace("=4", "=3"),
        imagej().replace("frames=4", "frames=-4"),
        imagej().replace("frames=4", "frames=four"),
    ],
)
def test_frames_that_are_claimed_but_not_there(
    tmp_path: Path, description: str, compression: str | None
) -> None:
    file = opened(tmp_path, description, "m.tif", compression=compression)
    assert any(UNNAMED in note for note in file.notes)


@pytest.mark.parametrize("frames", [40, 10**6])
def test_a_movie_that_was_stopped_ends_with_its_last_frame(tmp_path: Path, frames: int) -> None:
    file = opened(tmp_path, ome('TimeIncrement="2"', sizes=(32, 24, 1, 1, frames)))
    assert file.scale.frame_interval_s == 2.0
    assert f"claim {frames} frames, 4 are in the file" in file.notes[0]


def test_loss_is_told(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "m.tif", MOVIE, photometric="minisblack", compression="jpeg")
    assert "stored with loss (JPEG)" in open_frames(tmp_path / "m.tif").notes[0]
