import pickle
import struct
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import imagecodecs
import numpy as np
import pytest

from cytodisk.errors import ReadError
from cytodisk.images.contents import contents
from cytodisk.images.formats.microscope import czi_file
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames

pytest.importorskip("czifile", reason="reading CZI files needs the extra czi")

_GRAY16, _BGR24 = 1, 3


@dataclass
class Tile:
    """A block of a CZI file; pixels of shape (H, W) or (H, W, 3)."""

    pixels: np.ndarray
    places: str = ""  # as "T1 C0 S2 Y-5 X10"
    compression: int = 0
    shrunk: int = 1

    @property
    def entry(self) -> bytes:
        starts = {place[0]: int(place[1:]) for place in self.places.split()}
        height, width = self.pixels.shape[:2]
        sizes = {"X": width, "Y": height}
        axes = [*dict.fromkeys(["X", "Y", *starts])]
        packed = b"".join(
            struct.pack(
                "<4siifi",
                axis.encode(),
                starts.get(axis, 0),
                sizes.get(axis, 1) * (self.shrunk if axis in sizes else 1),
                0.0,
                sizes.get(axis, 1),
            )
            for axis in axes
        )
        kind = _BGR24 if self.pixels.ndim == 3 else _GRAY16
        return (
            struct.pack("<2siqiiBB4si", b"DV", kind, self.position, 0, self.compression, 0, 0, b"", len(axes))
            + packed
        )

    position: int = 0

    def data(self) -> bytes:
        plain = self.pixels.tobytes()
        if self.compression == 2:
            return bytes(imagecodecs.lzw_encode(plain))
        if self.compression == 5:
            return bytes(imagecodecs.zstd_encode(plain))
        if self.compression == 6:
            shuffled = np.frombuffer(plain, np.uint8).reshape(-1, 2).T.tobytes()
            return b"\x03\x01\x01" + bytes(imagecodecs.zstd_encode(shuffled))
        return plain


def _segment(kind: bytes, body: bytes) -> bytes:
    return struct.pack("<16sqq", kind, len(body), len(body)) + body


def write_czi(path: Path, tiles: Sequence[Tile], xml: str = "") -> Path:
    """A CZI file, just as much of it as its list of blocks, its metadata and its pixels."""
    document = f"<ImageDocument><Metadata>{xml}</Metadata></ImageDocument>".encode()
    parts, place = [], 32 + 512
    for tile in tiles:
        tile.position = place
        data = tile.data()
        head = struct.pack("<iiq", 0, 0, len(data)) + tile.entry
        parts.append(_segment(b"ZISRAWSUBBLOCK", head.ljust(256, b"\0") + data))
        place += len(parts[-1])
    entries = b"".join(tile.entry for tile in tiles)
    listed = _segment(b"ZISRAWDIRECTORY", struct.pack("<i124x", len(tiles)) + entries)
    said = _segment(b"ZISRAWMETADATA", struct.pack("<ii248x", len(document), 0) + document)
    identity = b"\0" * 32
    header = struct.pack("<iiii32siqqiq", 1, 0, 0, 0, identity, 0, place, place + len(listed), 0, 0)
    path.write_bytes(_segment(b"ZISRAWFILE", header.ljust(512, b"\0")) + b"".join(parts) + listed + said)
    return path


def _scaled(um: float, *, channels: Sequence[str] = (), offsets: str = "", axes: str = "XY") -> str:
    distances = "".join(f'<Distance Id="{axis}"><Value>{um * 1e-6}</Value></Distance>' for axis in axes)
    named = "".join(f'<Channel Name="{name}"/>' for name in channels)
    times = f"<T><Positions><List><Offsets>{offsets}</Offsets></List></Positions></T>" if offsets else ""
    return (
        f"<Scaling><Items>{distances}</Items></Scaling><Information><Image><Dimensions>"
        f"<Channels>{named}</Channels>{times}</Dimensions></Image></Information>"
    )


@pytest.fixture
def plane() -> np.ndarray:
    return np.random.default_rng(1).integers(0, 4000, (20, 30), np.uint16)


@pytest.mark.parametrize("compression", [0, 2, 5, 6])
def test_pixels_of_each_compression(tmp_path: Path, plane: np.ndarray, compression: int) -> None:
    file = open_frames(write_czi(tmp_path / "a.czi", [Tile(plane, compression=compression)]))
    assert (file.axes, file.shape, file.dtype) == ("YX", (20, 30), np.uint16)
    np.testing.assert_array_equal(file.frame(0)[0], plane)


def test_frames_channels_scale_and_times(tmp_path: Path, plane: np.ndarray) -> None:
    tiles = [Tile(plane + 10 * t + c, f"T{t} C{c}") for t in range(3) for c in range(2)]
    xml = _scaled(0.16, channels=("GFP", "mCherry"), offsets="0 5 10.2")
    file = open_frames(write_czi(tmp_path / "a.czi", tiles, xml))
    assert (file.axes, file.shape, file.channels) == ("TCYX", (3, 2, 20, 30), ("GFP", "mCherry"))
    assert (file.scale.pixel_size_um, file.scale.frame_interval_s) == (0.16, 5.1)
    again = pickle.loads(pickle.dumps(file))
    np.testing.assert_array_equal(again.frame(2)[1], plane + 21)


def test_a_z_stack_needs_a_slice_or_a_projection(tmp_path: Path, plane: np.ndarray) -> None:
    path = write_czi(tmp_path / "a.czi", [Tile(plane + np.uint16(z * z), f"Z{z}") for z in range(4)])
    with pytest.raises(ReadError, match=r"4 slices: pass one slice \(0 to 3\), as --z 2.*--z max"):
        open_frames(path)
    with pytest.raises(ReadError, match=r"no slice '4'.*--z max"):
        open_frames(path, choice=FileChoice(z="4"))
    np.testing.assert_array_equal(open_frames(path, choice=FileChoice(z="2")).frame(0)[0], plane + 4)
    np.testing.assert_array_equal(open_frames(path, choice=FileChoice(z="max")).frame(0)[0], plane + 9)
    mean = open_frames(path, choice=FileChoice(z="mean"))
    assert mean.dtype == np.float32
    np.testing.assert_allclose(mean.frame(0)[0], plane + 3.5)


def test_scenes_are_listed_and_tiles_put_together(
    tmp_path: Path, plane: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    left, right = Tile(plane, "S0 M0 X-10 Y4"), Tile(plane + 1, "S0 M1 X15 Y4")
    small = Tile(plane[::2, ::2].copy(), "S0 X-10 Y4", shrunk=2)
    path = write_czi(tmp_path / "a.czi", [right, left, small, Tile(plane + 2, "S3 X900")])
    with pytest.raises(
        ReadError,
        match=r"2 scenes: pass the number or the name of one, as --scene 0; there are 0 \(0\), 1 \(3\)",
    ):
        open_frames(path)
    assert [scene.image_shape for scene in contents(path).scenes] == [(20, 55), (20, 30)]
    whole = open_frames(path, choice=FileChoice(scene="0")).frame(0)[0]
    np.testing.assert_array_equal(whole[:, :25], plane[:, :25])
    np.testing.assert_array_equal(whole[:, 25:], plane + 1)  # the later tile lies on top
    assert open_frames(path, choice=FileChoice(scene="0")).stored.by_piece(0) is None
    monkeypatch.setattr(czi_file, "WHOLE_BYTES", 0)
    assert open_frames(path, choice=FileChoice(scene="3")).stored.by_piece(0) is None
    cut, together = open_frames(path, choice=FileChoice(scene="0")).stored.by_piece(0) or pytest.fail("tiles")
    assert together == 20
    np.testing.assert_array_equal(cut(slice(3, 9), slice(20, 40))[0], whole[3:9, 20:40])
    np.testing.assert_array_equal(cut(slice(0, 20), slice(40, 55))[0], whole[:, 40:])
    np.testing.assert_array_equal(open_frames(path, choice=FileChoice(scene="3")).frame(0)[0], plane + 2)


def test_colours_are_red_green_blue(tmp_path: Path) -> None:
    blue_green_red = np.random.default_rng(2).integers(0, 255, (20, 30, 3)).astype(np.uint8)
    file = open_frames(write_czi(tmp_path / "a.czi", [Tile(blue_green_red)]))
    assert file.channels == ("red", "green", "blue")
    np.testing.assert_array_equal(file.frame(0), np.moveaxis(blue_green_red[..., ::-1], 2, 0))


@pytest.mark.parametrize(
    ("xml", "note"),
    [
        (_scaled(0), "pixel size of 0 × 0 µm makes no sense.*--pixel-size"),
        (_scaled(0.1, offsets="0 5 60"), r"unevenly spaced \(5 to 55 s apart\).*--frame-interval"),
        (_scaled(0.1, offsets="0 5 5"), "do not grow.*--frame-interval"),
    ],
)
def test_metadata_that_make_no_sense_are_told(tmp_path: Path, plane: np.ndarray, xml: str, note: str) -> None:
    path = write_czi(tmp_path / "a.czi", [Tile(plane, f"T{t}") for t in range(3)], xml)
    file = open_frames(path)
    assert len(file.notes) == 1
    with pytest.raises(ValueError, match=note):
        raise ValueError(file.notes[0])
    assert None in (file.scale.pixel_size_um, file.scale.frame_interval_s)


def test_what_cannot_be_told_apart_is_refused(tmp_path: Path, plane: np.ndarray) -> None:
    path = write_czi(tmp_path / "phases.czi", [Tile(plane, f"H{h}") for h in range(3)])
    with pytest.raises(ReadError, match="holds 3 phases: save the processed image"):
        open_frames(path)
    path = write_czi(tmp_path / "larger.czi", [Tile(plane, shrunk=2)])
    with pytest.raises(ReadError, match=r"at another size than it shows them .*save the processed image"):
        open_frames(path)
    path = write_czi(tmp_path / "oblong.czi", [Tile(plane)], _scaled(0.1, axes="X") + _scaled(0.2, axes="Y"))
    with pytest.raises(ReadError, match=r"pixels of 0.2 × 0.1 µm: resample it to square pixels"):
        open_frames(path)
    path = write_czi(tmp_path / "a.czi", [Tile(plane)])
    with pytest.raises(ReadError, match="leave out --signal-axes"):
        open_frames(path, choice=FileChoice(axes="TYX"))


def test_a_stopped_recording_loses_its_missing_frames_alone(tmp_path: Path, plane: np.ndarray) -> None:
    path = write_czi(tmp_path / "a.czi", [Tile(plane, place) for place in ("T0 C0", "T0 C1", "T1 C0")])
    file = open_frames(path)
    np.testing.assert_array_equal(file.frame(0)[1], plane)
    with pytest.raises(ReadError, match=r"no pixels of frame 1, channel 1.*recording was stopped"):
        file.frame(1)


@pytest.mark.parametrize("xml", ["<Scaling>", "&;", "<a></b>", "\x01"])
def test_damaged_metadata_cost_the_metadata_alone(tmp_path: Path, plane: np.ndarray, xml: str) -> None:
    file = open_frames(write_czi(tmp_path / "a.czi", [Tile(plane)], xml))
    np.testing.assert_array_equal(file.frame(0)[0], plane)
    assert "its metadata are damaged" in file.notes[0]
    assert "--pixel-size" in file.notes[0]


@pytest.mark.parametrize("place", ["T99999999", "Z2000000000", "C5000", "T-3", "M1 X900000000"])
def test_claims_that_the_blocks_do_not_fill_are_refused(
    tmp_path: Path, plane: np.ndarray, place: str
) -> None:
    path = write_czi(tmp_path / "a.czi", [Tile(plane), Tile(plane, place)])
    with pytest.raises(ReadError, match="is damaged: its list of 2 blocks of pixels makes no sense"):
        open_frames(path)


def test_damaged_files_end_in_a_read_error(tmp_path: Path, plane: np.ndarray) -> None:
    whole = write_czi(tmp_path / "whole.czi", [Tile(plane, f"T{t}") for t in range(2)]).read_bytes()
    rng = np.random.default_rng(3)
    read = 0
    for trial in range(60):
        bad = bytearray(whole[: rng.integers(len(whole))] if trial % 2 else whole)
        for place in rng.integers(0, len(bad), 40 if trial % 3 else 0) if len(bad) else ():
            bad[place] = rng.integers(256)
        path = tmp_path / f"{trial}.czi"
        path.write_bytes(bytes(bad))
        with suppress(ReadError):
            file = open_frames(path)
            for number in range(min(file.n_frames, 3)):
                file.frame(number)
            read += 1
    assert 0 < read < 60  # and nothing but a ReadError came of the others


class TestRealFiles:
    """What stands in files of microscopes."""

    def test_time_series_with_slices(self, data_dir: Path) -> None:
        path = data_dir / "formats" / "CellDivision_T3_Z6_CH1_X300_Y200_DCV_ZSTD.czi"
        (scene,) = contents(path).scenes
        assert (scene.frames, scene.slices, scene.channels) == (3, 6, ("LED555",))
        file = open_frames(path, choice=FileChoice(z="max"))
        assert file.axes == "TYX"
        assert file.scale.pixel_size_um == pytest.approx(0.0905767, rel=1e-5)
        assert file.scale.frame_interval_s == pytest.approx(60.0755)
        slices = [open_frames(path, choice=FileChoice(z=str(z))).frame(1) for z in range(6)]
        np.testing.assert_array_equal(file.frame(1), np.max(slices, axis=0))
        assert file.frame(1).max() == 6559

    def test_channels_without_names_or_scale(self, data_dir: Path, capfd: pytest.CaptureFixture[str]) -> None:
        file = open_frames(data_dir / "formats" / "DAPI_GFP.czi")
        assert capfd.readouterr() == ("", "")  # no line of the library's log
        assert (file.axes, file.shape, file.scale.pixel_size_um) == ("CYX", (2, 640, 640), None)
        assert file.frame(0).std() > 10

    def test_scenes_with_tiles(self, data_dir: Path) -> None:
        path = data_dir / "formats" / "S3_1Pos_2Mosaic_T1_Z1_CH1.czi"
        with pytest.raises(ReadError, match=r"3 scenes: .* there are 0 \(TR1\), 1 \(P1\), 2 \(TR2\)"):
            open_frames(path)
        shapes = [scene.image_shape for scene in contents(path).scenes]
        assert shapes == [(122, 295), (64, 64), (237, 352)]
        by_name = open_frames(path, choice=FileChoice(scene="P1"))
        assert (by_name.image_shape, by_name.channels, by_name.scale.pixel_size_um) == (
            (64, 64),
            ("DAPI",),
            1.6,
        )
        assert by_name.frame(0).min() == 466
