import pickle
import struct
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from cytodisk.errors import ReadError
from cytodisk.images.contents import contents
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames

pytest.importorskip("liffile", reason="reading LIF files needs the extra lif")

_DIMENSIONS = {"X": 1, "Y": 2, "Z": 3, "T": 4, "H": 6, "N": 7, "M": 10}


def _element(
    name: str,
    stack: np.ndarray,
    axes: str,
    step: dict[str, float],
    luts: Sequence[str],
    times: Sequence[float],
) -> str:
    """Description of an image; a look-up table may have a dye, as "Green/GFP"."""
    increments = {axis: stack.strides[place] for place, axis in enumerate(axes)}
    described = "".join(
        f'<DimensionDescription DimID="{_DIMENSIONS[axis]}" NumberOfElements="{size}" Origin="0" '
        f'Length="{step.get(axis, 0) * (size - 1)}" Unit="m" BytesInc="{increments[axis]}" BitInc="0"/>'
        for axis, size in zip(axes, stack.shape, strict=True)
        if axis != "C"
    )
    dyed = "<ChannelProperty><Key>DyeName</Key><Value>{}</Value></ChannelProperty>"
    shown = [lut.partition("/") for lut in luts[: stack.shape[axes.index("C")] if "C" in axes else 1]]
    channels = "".join(
        f'<ChannelDescription DataType="0" ChannelTag="0" Resolution="16" NameOfMeasuredQuantity="" Min="0" '
        f'Max="1" Unit="" LUTName="{lut}" IsLUTInverted="0" BytesInc="{number * increments.get("C", 0)}" '
        f'BitInc="0">{dyed.format(dye) if dye else ""}</ChannelDescription>'
        for number, (lut, _, dye) in enumerate(shown)
    )
    ticks = " ".join(f"{132500000000000000 + round(time * 1e7):x}" for time in times)
    stamps = f'<TimeStampList NumberOfTimeStamps="{len(times)}">{ticks}</TimeStampList>' if times else ""
    return (
        f'<Element Name="{name}" UniqueID="{name}"><Data><Image><ImageDescription>'
        f"<Channels>{channels}</Channels><Dimensions>{described}</Dimensions></ImageDescription>{stamps}"
        f'</Image></Data><Memory Size="{stack.nbytes}" MemoryBlockID="Mem_{name}"/></Element>'
    )


def write_lif(
    path: Path,
    images: dict[str, tuple[np.ndarray, str]],
    step: dict[str, float] | None = None,
    luts: Sequence[str] = ("Green",),
    times: Sequence[float] = (),
) -> Path:
    """A LIF file: images by name, each with its axes."""
    described = "".join(
        _element(name, stack, axes, step or {}, luts, times) for name, (stack, axes) in images.items()
    )
    xml = (
        '<LMSDataContainerHeader Version="2"><Element Name="project" UniqueID="p"><Children>'
        f"{described}</Children></Element></LMSDataContainerHeader>"
    ).encode("utf-16-le")
    parts = [struct.pack("<IIBI", 0x70, len(xml) + 5, 0x2A, len(xml) // 2) + xml]
    for name, (stack, _) in images.items():
        block = f"Mem_{name}".encode("utf-16-le")
        parts.append(
            struct.pack("<IIBQBI", 0x70, 0, 0x2A, stack.nbytes, 0x2A, len(block) // 2)
            + block
            + stack.tobytes()
        )
    path.write_bytes(b"".join(parts))
    return path


@pytest.fixture
def stack() -> np.ndarray:
    return np.random.default_rng(1).integers(0, 4000, (3, 4, 2, 20, 30), np.uint16)


def test_frames_channels_slices_and_scale(tmp_path: Path, stack: np.ndarray) -> None:
    step = {"X": 1.6e-7, "Y": 1.6e-7, "Z": 1e-6, "T": 5.0}
    path = write_lif(tmp_path / "a.lif", {"cell": (stack, "TZCYX")}, step, ("Green", "Red"))
    with pytest.raises(ReadError, match=r"z-stack of 4 slices: pass one slice \(0 to 3\), as --z 2"):
        open_frames(path)
    file = pickle.loads(pickle.dumps(open_frames(path, choice=FileChoice(z="1"))))
    assert (file.axes, file.shape, file.channels) == ("TCYX", (3, 2, 20, 30), ("Green", "Red"))
    assert (file.scale.pixel_size_um, file.scale.frame_interval_s) == (0.16, 5.0)
    np.testing.assert_array_equal(file.frame(2), stack[2, 1])
    mean = open_frames(path, choice=FileChoice(z="mean")).frame(0)
    np.testing.assert_allclose(mean, stack[0].mean(axis=0), rtol=1e-6)


@pytest.mark.parametrize(
    ("times", "interval", "said"),
    [
        ((0, 5, 10), 5.0, ""),
        ((0, 5.5, 11), 5.5, ""),
        ((0, 8, 16), None, "were 8 s apart and 5 s was set.*--frame-interval"),
        ((0, 5, 20), None, "unevenly spaced.*--frame-interval"),
        ((), 5.0, ""),
    ],
)
def test_times_of_frames_against_the_interval_that_was_set(
    tmp_path: Path, stack: np.ndarray, times: Sequence[float], interval: float | None, said: str
) -> None:
    movie = stack[:, 0, 0].copy()
    path = write_lif(tmp_path / "a.lif", {"cell": (movie, "TYX")}, {"T": 5.0}, times=times)
    file = open_frames(path)
    assert (file.scale.frame_interval_s, len(file.notes)) == (interval, bool(said))
    if said:
        with pytest.raises(ValueError, match=said):
            raise ValueError(file.notes[0])


def test_images_are_scenes_by_number_or_name(tmp_path: Path, stack: np.ndarray) -> None:
    one, two = stack[0, 0, 0].copy(), stack[:, 0, 0].copy()
    path = write_lif(tmp_path / "a.lif", {"overview": (one, "YX"), "cell 7": (two, "TYX")})
    with pytest.raises(ReadError, match=r"2 scenes: .* --scene 0; there are 0 \(overview\), 1 \(cell 7\)"):
        open_frames(path)
    with pytest.raises(ReadError, match=r"2 scenes and none is 'cell': .* --scene 0"):
        open_frames(path, choice=FileChoice(scene="cell"))
    for scene in ("1", "cell 7"):
        np.testing.assert_array_equal(open_frames(path, choice=FileChoice(scene=scene)).frame(2)[0], two[2])


def test_sections_and_mosaics_are_refused_with_the_reason(tmp_path: Path, stack: np.ndarray) -> None:
    upright = stack[0, :, 0].copy()
    path = write_lif(
        tmp_path / "xz.lif", {"xz": (stack[0, :, 0, 0].copy(), "ZX"), "cell": (upright[0], "YX")}
    )
    with pytest.raises(ReadError, match=r"2 scenes: .* --scene 1; there are 1 \(cell\)"):
        open_frames(path)
    with pytest.raises(
        ReadError, match=r"scene 0 \(xz\), is a scan along the axes Z, X, not an image of the plane"
    ):
        open_frames(path, choice=FileChoice(scene="0"))
    path = write_lif(tmp_path / "xzy.lif", {"xzy": (upright, "YZX")})
    with pytest.raises(ReadError, match=r"upright sections \(ZX\): save it as a stack of planes"):
        open_frames(path)
    path = write_lif(tmp_path / "tiles.lif", {"tiles": (upright, "MYX")})
    with pytest.raises(ReadError, match="holds 4 tiles: export one of them, or merge them, in LAS X"):
        open_frames(path)


def test_an_image_of_an_unknown_layout_leaves_the_others_readable(tmp_path: Path, stack: np.ndarray) -> None:
    images = {"odd": (stack[0, 0].copy(), "CYX"), "cell": (stack[0, 0, 0].copy(), "YX")}
    path = write_lif(tmp_path / "a.lif", images, luts=("Green", "Red"))
    raw = path.read_bytes()
    first = 'Resolution="16"'.encode("utf-16-le")
    path.write_bytes(raw.replace(first, 'Resolution="08"'.encode("utf-16-le"), 1))
    odd, cell = contents(path).scenes
    assert "has a layout that is not known (heterogeneous channel data types" in odd.fault
    assert not cell.fault
    with pytest.raises(ReadError, match=r"scene 0 \(odd\), has a layout .*: export it as TIFF"):
        open_frames(path, choice=FileChoice(scene="odd"))


def test_a_channel_is_called_after_its_dye(tmp_path: Path, stack: np.ndarray) -> None:
    path = write_lif(tmp_path / "a.lif", {"cell": (stack[0, 0].copy(), "CYX")}, luts=("Green/GFP", "Red"))
    assert open_frames(path).channels == ("GFP", "Red")


def test_a_file_that_is_cut_short_loses_its_last_frames_alone(tmp_path: Path, stack: np.ndarray) -> None:
    movie = stack[:, 0, 0].copy()
    path = write_lif(tmp_path / "cut.lif", {"cell": (movie, "TYX")})
    whole = path.read_bytes()
    path.write_bytes(whole[:-100])
    file = open_frames(path)
    assert "it is cut short: its pixels need 3600 bytes and 3500 are there" in file.notes[0]
    np.testing.assert_array_equal(file.frame(1)[0], movie[1])
    with pytest.raises(ReadError, match=r"cut\.lif: frame 2"):
        file.frame(2)
    path.write_bytes(whole[:-3590])
    with pytest.raises(ReadError, match="damaged or cut short: its pixels need 3600 bytes and 10 are there"):
        open_frames(path)


def test_damaged_files_end_in_a_read_error(tmp_path: Path, stack: np.ndarray) -> None:
    whole = write_lif(tmp_path / "whole.lif", {"cell": (stack[:, 0, 0].copy(), "TYX")}).read_bytes()
    rng = np.random.default_rng(3)
    read = 0
    for trial in range(60):
        bad = bytearray(whole[: rng.integers(len(whole))] if trial % 2 else whole)
        for place in rng.integers(0, min(len(bad), 2500), 30 if trial % 3 else 0) if len(bad) else ():
            bad[place] = rng.integers(256)
        path = tmp_path / f"{trial}.lif"
        path.write_bytes(bytes(bad))
        with suppress(ReadError):
            file = open_frames(path)
            for number in range(min(file.n_frames, 3)):
                file.frame(number)
            read += 1
    assert 0 < read < 60  # and nothing but a ReadError came of the others


class TestRealFiles:
    """What stands in files of microscopes."""

    def test_steps_of_a_wavelength_are_channels(self, data_dir: Path) -> None:
        path = data_dir / "formats" / "wavelength-sweep.lif"
        emission, excitation, movie = contents(path).scenes
        assert (len(emission.channels), emission.channels[0]) == (20, "550 nm emission")
        assert (len(excitation.channels), excitation.channels[-1]) == (15, "560 nm excitation")
        assert (movie.frames, movie.slices, len(movie.channels)) == (2, 11, 10)
        assert movie.scale.pixel_size_um == pytest.approx(0.104814, rel=1e-5)
        assert movie.scale.frame_interval_s == pytest.approx(80.91)
        file = open_frames(path, choice=FileChoice(scene="2", z="5"))
        assert (file.axes, file.shape) == ("TCYX", (2, 10, 64, 64))
        assert file.frame(1).any()

    def test_scans_of_sections_are_refused(self, data_dir: Path) -> None:
        path = data_dir / "formats" / "xz-example.lif"
        assert all(scene.fault for scene in contents(path).scenes)
        with pytest.raises(
            ReadError, match=r"3 scenes and none can be read; the first \(xzt\) is a scan along"
        ):
            open_frames(path, choice=FileChoice(scene="1"))
