"""ND2 files through the interface of the package nd2: no package writes such files."""

import pickle
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cytodisk.errors import ReadError
from cytodisk.images.contents import contents
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames

nd2 = pytest.importorskip("nd2", reason="reading ND2 files needs the extra nd2")
structures = pytest.importorskip("nd2.structures")

_LETTERS = {"TimeLoop": "T", "NETimeLoop": "T", "XYPosLoop": "P", "ZStackLoop": "Z", "CustomLoop": "U"}


def time_loop(count: int, period_ms: float) -> Any:
    return structures.TimeLoop(
        count, 0, structures.TimeLoopParams(0.0, period_ms, 0.0, structures.PeriodDiff())
    )


def positions(*names: str | None) -> Any:
    points = [structures.Position(structures.StagePosition(0, 0, 0), None, name) for name in names]
    return structures.XYPosLoop(len(names), 0, structures.XYPosLoopParams(False, points))


def z_stack(count: int) -> Any:
    return structures.ZStackLoop(count, 0, structures.ZStackLoopParams(0, 1.0, True))


@dataclass
class Recording:
    """What stands in an ND2 file: images of shape (channels, H, W), in the order of the loops."""

    images: np.ndarray
    experiment: list[Any] = field(default_factory=list)
    names: tuple[str, ...] = ("GFP", "mCherry")
    pixel_um: tuple[float, float] = (0.16, 0.16)
    calibrated: bool = True
    times_ms: tuple[float, ...] = ()
    recorded: int | None = None
    samples: int = 1
    is_legacy: bool = False

    def channel(self, name: str, time_ms: float | None = None) -> Any:
        volume = structures.Volume(
            axesCalibrated=(self.calibrated,) * 3,
            axesCalibration=(*self.pixel_um, 1.0) if self.calibrated else (1.0, 1.0, 1.0),
            axesInterpretation=("distance",) * 3,
            bitsPerComponentInMemory=16,
            bitsPerComponentSignificant=16,
            cameraTransformationMatrix=(1.0, 0.0, 0.0, 1.0),
            componentCount=1,
            componentDataType="unsigned",
            voxelCount=(30, 20, 1),
        )
        meta = structures.ChannelMeta(name, 0, structures.Color(0, 0, 0))
        if time_ms is None:
            return structures.Channel(meta, None, structures.Microscope(), volume)
        place = structures.Position(structures.StagePosition(0, 0, 0))
        stamp = structures.TimeStamp(0.0, time_ms)
        return structures.FrameChannel(meta, None, structures.Microscope(), volume, place, stamp)


class StandIn:
    """`nd2.ND2File` as its documentation describes it, with what is asked of it."""

    recording: Recording

    def __init__(self, path: Path) -> None:
        self.path = path
        self.closed = False
        self.experiment = self.recording.experiment
        self.is_legacy = self.recording.is_legacy

    def __enter__(self) -> "StandIn":
        return self

    def __exit__(self, *_: object) -> None:
        self.closed = True

    @property
    def components_per_channel(self) -> int:
        return self.recording.samples

    @property
    def is_rgb(self) -> bool:
        return self.recording.samples in (3, 4)

    @property
    def dtype(self) -> np.dtype:
        return self.recording.images.dtype

    @property
    def attributes(self) -> Any:
        images = self.recording.images
        count = images.shape[1] * self.recording.samples
        recorded = len(images) if self.recording.recorded is None else self.recording.recorded
        return structures.Attributes(
            16,
            16,
            count,
            images.shape[2],
            "unsigned",
            recorded,
            None,
            images.shape[3],
            channelCount=images.shape[1],
        )

    @property
    def sizes(self) -> dict[str, int]:
        images = self.recording.images
        sizes = {_LETTERS[loop.type]: loop.count for loop in self.experiment}
        sizes |= {
            "C": images.shape[1],
            "Y": images.shape[2],
            "X": images.shape[3],
            "S": self.recording.samples,
        }
        return {axis: size for axis, size in sizes.items() if size != 1}

    @property
    def metadata(self) -> Any:
        channels = [self.recording.channel(name) for name in self.recording.names]
        return structures.Metadata(None, channels)

    def frame_metadata(self, number: int) -> Any:
        times = self.recording.times_ms
        channels = [self.recording.channel("GFP", times[number])] if times else []
        return structures.FrameMetadata(structures.Contents(1, len(times)), channels)

    def read_frame(self, number: int) -> np.ndarray:
        assert not self.closed
        images = self.recording.images
        return np.squeeze(images[number] if number < len(images) else np.zeros_like(images[0]))


@pytest.fixture
def nd2_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Make the reader find a recording in a file."""
    monkeypatch.setattr(nd2, "ND2File", StandIn)

    def make(recording: Recording) -> Path:
        monkeypatch.setattr(StandIn, "recording", recording, raising=False)
        path = tmp_path / "a.nd2"
        path.write_bytes(bytes(recording.images.nbytes))
        return path

    return make


@pytest.fixture
def images() -> np.ndarray:
    """For 3 times, 2 positions and 4 slices, in this order of loops."""
    return np.random.default_rng(1).integers(1, 4000, (24, 2, 20, 30), np.uint16)


def test_the_stand_in_has_the_interface_of_the_package() -> None:
    real = vars(__import__("nd2", fromlist=["ND2File"]).ND2File)
    used = {
        "experiment",
        "is_legacy",
        "components_per_channel",
        "is_rgb",
        "dtype",
        "attributes",
        "sizes",
        "metadata",
        "frame_metadata",
        "read_frame",
    }
    assert used <= set(real)


def test_positions_slices_channels_and_scale(nd2_file: Any, images: np.ndarray) -> None:
    loops = [time_loop(3, 5000.0), positions("first", None), z_stack(4)]
    path = nd2_file(Recording(images, loops))
    with pytest.raises(ReadError, match=r"2 scenes: .* --scene 0; there are 0 \(first\), 1 \(1\)"):
        open_frames(path)
    with pytest.raises(ReadError, match=r"z-stack of 4 slices: pass one slice \(0 to 3\), as --z 2"):
        open_frames(path, choice=FileChoice(scene="first"))
    file = pickle.loads(pickle.dumps(open_frames(path, choice=FileChoice(scene="1", z="2"))))
    assert (file.axes, file.shape, file.channels) == ("TCYX", (3, 2, 20, 30), ("GFP", "mCherry"))
    assert (file.scale.pixel_size_um, file.scale.frame_interval_s, file.notes) == (0.16, 5.0, ())
    stored = images.reshape(3, 2, 4, 2, 20, 30)
    for frame in range(3):
        np.testing.assert_array_equal(file.frame(frame), stored[frame, 1, 2])
    highest = open_frames(path, choice=FileChoice(scene="0", z="max"))
    np.testing.assert_array_equal(highest.frame(1), stored[1, 0].max(axis=0))
    assert (
        contents(path)
        .lines[1]
        .startswith("  scene 0 (first): 3 frames, 4 slices in z, 2 channels (GFP, mCherry)")
    )


def test_loops_in_another_order(nd2_file: Any, images: np.ndarray) -> None:
    path = nd2_file(Recording(images, [positions("a", "b"), z_stack(4), time_loop(3, 0.0)]))
    file = open_frames(path, choice=FileChoice(scene="b", z="3"))
    np.testing.assert_array_equal(file.frame(2), images.reshape(2, 4, 3, 2, 20, 30)[1, 3, 2])
    assert file.scale.frame_interval_s is None


def test_a_single_image_and_one_channel(nd2_file: Any, images: np.ndarray) -> None:
    file = open_frames(nd2_file(Recording(images[:1, :1], names=("DAPI",))))
    assert (file.axes, file.shape, file.channels) == ("YX", (20, 30), ("DAPI",))
    np.testing.assert_array_equal(file.frame(0), images[0, :1])


def test_colour_images(nd2_file: Any) -> None:
    colours = np.random.default_rng(2).integers(1, 255, (1, 1, 20, 30, 3)).astype(np.uint8)
    file = open_frames(nd2_file(Recording(colours, names=("",), samples=3)))
    assert file.channels == ("red", "green", "blue")
    np.testing.assert_array_equal(file.frame(0), np.moveaxis(colours[0, 0], 2, 0))


@pytest.mark.parametrize(
    ("period_ms", "times_ms", "interval", "said"),
    [
        (5000.0, (100.0, 5100.0, 10100.0), 5.0, ""),
        (0.0, (100.0, 350.0, 600.0), 0.25, ""),
        (5000.0, (), 5.0, ""),
        (5000.0, (0.0, 25000.0, 50000.0), None, "were 25 s apart and 5 s was set.*--frame-interval"),
        (5000.0, (0.0, 5000.0, 60000.0), None, r"unevenly spaced \(5 to 55 s apart\).*--frame-interval"),
        (5000.0, (0.0, 0.0, 0.0), None, "do not grow.*--frame-interval"),
    ],
)
def test_times_of_frames(
    nd2_file: Any,
    images: np.ndarray,
    period_ms: float,
    times_ms: tuple[float, ...],
    interval: float | None,
    said: str,
) -> None:
    path = nd2_file(Recording(images[:3], [time_loop(3, period_ms)], times_ms=times_ms))
    file = open_frames(path)
    assert (file.scale.frame_interval_s, len(file.notes)) == (interval, bool(said))
    if said:
        with pytest.raises(ValueError, match=said):
            raise ValueError(file.notes[0])


def test_a_pixel_size_that_is_not_calibrated_is_not_believed(nd2_file: Any, images: np.ndarray) -> None:
    file = open_frames(nd2_file(Recording(images[:1], calibrated=False)))
    assert file.scale.pixel_size_um is None
    assert "--pixel-size" in file.notes[0]
    with pytest.raises(ReadError, match=r"pixels of 0.2 × 0.1 µm: resample it to square pixels"):
        open_frames(nd2_file(Recording(images[:1], pixel_um=(0.1, 0.2))))


def test_a_stopped_recording_is_told_and_missing_frames_are_no_zeros(
    nd2_file: Any, images: np.ndarray
) -> None:
    movie = np.concatenate([images[:3], np.zeros_like(images[:2])])
    path = nd2_file(Recording(movie, [time_loop(5, 5000.0)], recorded=4))
    file = open_frames(path)
    assert "4 of 5 images are there" in file.notes[0]
    np.testing.assert_array_equal(file.frame(2), images[2])
    for frame in (3, 4):  # one is zeros, as the package gives for what it cannot find
        with pytest.raises(
            ReadError, match=f"no pixels of frame {frame}, slice 0: the recording was stopped"
        ):
            file.frame(frame)


def test_loops_of_one_step_are_no_axes(nd2_file: Any, images: np.ndarray) -> None:
    once = [time_loop(1, 0.0), structures.CustomLoop(1), time_loop(3, 5000.0), z_stack(1), time_loop(1, 0.0)]
    file = open_frames(nd2_file(Recording(images[:3], once)))
    assert (file.axes, file.shape) == ("TCYX", (3, 2, 20, 30))
    np.testing.assert_array_equal(file.frame(2), images[2])
    file = open_frames(nd2_file(Recording(images[:5], [time_loop(3, 5000.0)])))
    assert file.notes == ("it holds 5 images and its loops tell of 3: the others are not read",)


def test_claims_that_the_file_does_not_fill_are_refused(nd2_file: Any, images: np.ndarray) -> None:
    path = nd2_file(Recording(images[:2], [time_loop(10**9, 5000.0)]))
    with pytest.raises(ReadError, match="it claims 1000000000 images and 2 are there; copy it again"):
        open_frames(path)
    path = nd2_file(Recording(images[:2], [time_loop(2, 5000.0)], recorded=10**9))
    with pytest.raises(ReadError, match=r"says it holds .* are stored"):
        open_frames(path)


def test_what_cannot_be_told_apart_is_refused(nd2_file: Any, images: np.ndarray) -> None:
    path = nd2_file(Recording(images[:2], [structures.CustomLoop(2)]))
    with pytest.raises(ReadError, match=r"other loops .*\(CustomLoop\): save it as TIFF"):
        open_frames(path)
    path = nd2_file(Recording(images[:4], [time_loop(2, 1.0), time_loop(2, 1.0)]))
    with pytest.raises(ReadError, match="other loops than one of time"):
        open_frames(path)
    with pytest.raises(ReadError, match=r"before 2010 .*save it anew in NIS-Elements"):
        open_frames(nd2_file(Recording(images[:1], is_legacy=True)))


def test_files_that_are_no_nd2_end_in_a_read_error(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    starts = (
        b"",
        b"\xda\xce\xbe\x0a",
        b"\x00\x00\x00\x0cjP  ",
        b"\xda\xce\xbe\x0a\x00\x00\x00\x00ND2 FILE SIGNATURE CHUNK NAME01!",
    )
    for trial in range(40):
        path = tmp_path / f"{trial}.nd2"
        path.write_bytes(starts[trial % 4] + rng.bytes(int(rng.integers(3000))))
        with pytest.raises(ReadError, match=path.name):
            open_frames(path)
