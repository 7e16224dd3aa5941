"""What a user may hand in by mistake: each ends in a message, or in a row with its reason."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from movie_files import SMALL, damage, write_masks

import cytodisk as cd
from cytodisk.errors import CytodiskError, MaskError, ParameterError, ReadError, SignalError, StudyError
from cytodisk.images.frames import open_frames
from cytodisk.images.tracks import read_frame
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.runs.parameters_file import parameters_from

FRAMES, SHAPE = 6, (44, 52)


def growing(frames: int = FRAMES) -> np.ndarray:
    y, x = np.indices(SHAPE)
    radius = 11.0 + 0.5 * np.arange(frames)[:, None, None]
    return ((y - 21.0) ** 2 + (x - 25.0) ** 2 < radius**2).astype(np.uint8)


MASKS = growing()
COUNTS = np.random.default_rng(0).poisson(100, (FRAMES, 2, *SHAPE)).astype(np.uint16)


@pytest.fixture
def masks(tmp_path: Path) -> Path:
    return write_masks(tmp_path / "masks.tif", MASKS)


def written(path: Path, values: np.ndarray, axes: str | None = None) -> Path:
    options: dict[str, Any] = {} if axes is None else {"ome": True, "metadata": {"axes": axes}}
    tifffile.imwrite(path, values, photometric="minisblack", compression="zlib", **options)
    return path


def ran(folder: Path, masks: np.ndarray, signal: np.ndarray | None = None) -> cd.Study:
    paths = write_masks(folder / "these.tif", masks), None
    if signal is not None:
        paths = paths[0], written(folder / "signal.tif", signal, "TCYX")
    return movie_study(open_movie(*paths, SMALL), folder / "out")


@pytest.mark.parametrize(
    ("shape", "axes", "words"),
    [
        ((5, 2, *SHAPE), "TCYX", ["5 frames of 2 channels", "the masks have 6 frames", "pass as many"]),
        ((2, *SHAPE), "CYX", ["1 frames of 2 channels", "pass as many"]),
        (SHAPE, "YX", ["1 frames of 1 channels", "pass as many"]),
        ((6, *SHAPE), "CYX", ["its 6 channels look like frames", "save it with axes TYX or TCYX"]),
        ((6, 44, 53), "TYX", [r"images of \(44, 53\), the masks of \(44, 52\)", "same height and width"]),
        ((6, 44, 53), "CYX", ["its 6 channels look like frames"]),
        ((6, 2, *SHAPE), "TZYX", ["z-stack", "project it"]),
    ],
)
def test_a_signal_that_does_not_fit(
    tmp_path: Path, masks: Path, shape: tuple[int, ...], axes: str, words: list[str]
) -> None:
    signal = written(tmp_path / "signal.ome.tif", np.ones(shape, dtype=np.uint16), axes)
    for word in words:
        with pytest.raises((SignalError, ReadError), match=rf"signal\.ome\.tif.*{word}"):
            open_movie(masks, signal, SMALL)


def test_a_signal_that_is_no_numbers(tmp_path: Path, masks: Path) -> None:
    signal = written(tmp_path / "signal.tif", np.ones((FRAMES, *SHAPE), dtype=np.complex64))
    with pytest.raises(SignalError, match="of type complex64, which cannot be measured: save it as uint16"):
        open_movie(masks, signal, SMALL)


def test_masks_with_time_on_the_last_axis(tmp_path: Path) -> None:
    path = written(tmp_path / "masks.tif", np.moveaxis(MASKS, 0, -1))
    with pytest.raises(MaskError, match=r"44 frames of 52 × 6 pixels.*time"):
        open_movie(path, None, SMALL)


def test_masks_that_were_saved_as_channels(tmp_path: Path) -> None:
    path = written(tmp_path / "masks.ome.tif", MASKS, "CYX")
    words = r"one frame with 6 channels \(CYX \(6, 44, 52\)\): if these are frames, pass --axes TYX"
    with pytest.raises(MaskError, match=words):
        open_movie(path, None, SMALL)


def test_a_single_frame_is_no_movie(tmp_path: Path) -> None:
    path = written(tmp_path / "mask.tif", MASKS[0])
    with pytest.raises(MaskError, match=r"one frame.*cytodisk map"):
        open_movie(path, None, SMALL)


def test_masks_with_time_and_channels(tmp_path: Path) -> None:
    path = written(tmp_path / "masks.ome.tif", np.stack([MASKS, MASKS], axis=1), "TCYX")
    with pytest.raises(MaskError, match=r"2 channels.*one value a pixel"):
        open_movie(path, None, SMALL)


def test_a_picture_is_no_movie_of_masks(tmp_path: Path) -> None:
    path = written(tmp_path / "picture.tif", COUNTS[:, 0])
    with pytest.raises(MaskError, match=r"picture.*threshold"):
        open_movie(path, None, SMALL)


def test_masks_of_floats_0_and_1_are_masks(tmp_path: Path) -> None:
    study = ran(tmp_path, MASKS.astype(np.float32))
    assert study.cells["status"].tolist() == ["ok"] * FRAMES
    assert study.cells["area_px"].tolist() == MASKS.sum(axis=(1, 2)).tolist()


def test_a_frame_of_shares_is_refused_alone(tmp_path: Path) -> None:
    values = MASKS.astype(np.float32)
    values[2] *= 0.3
    study = ran(tmp_path, values)
    assert study.cells["status"].tolist() == ["ok", "ok", "refused", "ok", "ok", "ok"]
    assert "mask is float32 with values other than 0 and 1" in study.cells["reason"][2]
    assert "threshold it first" in study.cells["reason"][2]


def test_an_empty_frame_is_refused_and_the_movie_goes_on(tmp_path: Path) -> None:
    values = MASKS.copy()
    values[3] = 0
    study = ran(tmp_path, values, COUNTS)
    assert study.cells["status"].tolist() == ["ok"] * 3 + ["refused"] + ["ok"] * 2
    assert "is empty: no pixel belongs to the cell" in study.cells["reason"][3]
    assert 3 not in set(study.windows["frame"])
    assert study.edge.loc[study.edge["frame"] == 4, "velocity"].notna().all()
    with pytest.raises(ReadError, match=r"has no map: .*is empty"):
        study.map(0, 3)


def test_the_first_frames_may_be_empty(tmp_path: Path) -> None:
    values = MASKS.copy()
    values[:2] = 0
    study = ran(tmp_path, values)
    assert study.cells["status"].tolist() == ["refused"] * 2 + ["ok"] * 4
    assert set(study.edge["frame"]) == {2, 3, 4, 5}
    assert study.movie(0).transforms[2] is not None


def test_a_cell_that_leaves_has_no_velocity_in_its_last_frame(tmp_path: Path) -> None:
    values = MASKS.copy()
    values[4:] = 0
    study = ran(tmp_path, values)
    assert study.cells["status"].tolist() == ["ok"] * 4 + ["refused"] * 2
    last = study.edge[study.edge["frame"] == 3]
    assert last["velocity"].isna().all()
    assert last["status"].str.startswith("the next frame has no map: ").all()
    assert study.activity(0)["frame"].size == FRAMES


def test_a_frame_in_two_pieces_is_mapped_with_notes(tmp_path: Path) -> None:
    values = MASKS.copy()
    values[2, 1:4, 1:4] = 1
    study = ran(tmp_path, values)
    assert study.cells["status"].tolist() == ["ok"] * FRAMES
    assert study.cells["components"].tolist() == [1, 1, 2, 1, 1, 1]
    assert study.cells["dropped_px"][2] == 9
    assert "fragment" in study.cells["notes"][2]
    assert study.cells["area_px"][2] == MASKS[2].sum()


def test_nan_in_the_signal_is_counted_in_its_frame(tmp_path: Path) -> None:
    counts = COUNTS.astype(np.float32)
    counts[2, 1, 21, 25] = np.nan
    study = ran(tmp_path, MASKS, counts)
    assert study.cells["nan_px"].tolist() == [0, 0, 1, 0, 0, 0]
    lost = study.windows[study.windows["status"] == "NaN in signal"]
    assert set(zip(lost["frame"], lost["channel"], strict=True)) == {(2, "signal 2")}
    assert study.windows["mean"].isna().sum() == len(lost)
    assert study.windows["n_nan"].sum() == pytest.approx(1.0)


def test_a_movie_of_empty_frames_has_a_reason_for_each(tmp_path: Path) -> None:
    study = ran(tmp_path, np.zeros_like(MASKS), COUNTS)
    assert study.cells["status"].tolist() == ["refused"] * FRAMES
    assert study.cells["reason"].str.contains("is empty").all()
    assert len(study.windows) == len(study.edge) == len(study.consistency) == 0
    assert np.isnan(study.activity(0)["mean"]).all()
    assert not study.movie(0).mapped.any()
    deep = SMALL.model_copy(update={"depth_um": 1.0, "pixel_size_um": 0.1})
    assert open_movie(tmp_path / "these.tif", None, deep).grid.layers == 2  # no frame is looked at for that


@pytest.mark.parametrize("kind", ["masks", "signal"])
@pytest.mark.parametrize("time", [0, 3, FRAMES - 1])
def test_a_damaged_frame_loses_that_frame_alone(tmp_path: Path, kind: str, time: int) -> None:
    masks = write_masks(tmp_path / "masks.tif", MASKS)
    signal = written(tmp_path / "signal.tif", COUNTS, "TCYX")
    damage(*((masks, time) if kind == "masks" else (signal, 2 * time + 1)))
    study = movie_study(open_movie(masks, signal, SMALL), tmp_path / "out")
    expected = ["ok"] * FRAMES
    expected[time] = "unreadable"
    assert study.cells["status"].tolist() == expected
    assert f"{kind}.tif: frame {time} cannot be read as an image" in study.cells["reason"][time]
    assert set(study.windows["frame"]) == set(range(FRAMES)) - {time}
    assert study.windows["mean"].notna().all()
    assert len(study.provenance["warnings"]) == 1


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"frame_interval_s": 0.0}, "frame_interval_s must be a number from 0.000001 to 1000000, got 0.0"),
        ({"frame_interval_s": -5.0}, "frame_interval_s must be a number from 0.000001 to 1000000, got -5.0"),
        ({"frame_interval_s": float("nan")}, "frame_interval_s must .*got nan"),
        ({"pixel_size_um": 0.0}, "pixel_size_um must be a number from 0.000001 to 1000000, got 0.0"),
        ({"depth_um": -1.0}, "depth_um must be a depth above 0 or several that increase.*got -1.0"),
        ({"depth_um": (1.0, 0.5)}, "depth_um must be a depth above 0 or several that increase"),
        ({"depth_um": True}, "depth_um must be a depth above 0 or several that increase"),
        ({"depth_um": ()}, "depth_um must be a depth above 0 or several that increase"),
        ({"depth_um": ("a",)}, "depth_um must be a depth above 0 or several that increase"),
        ({"spacing": "area", "depth_um": 1.0}, "spacing and depth_um exclude each other"),
        ({"tracker": "snake"}, "tracker must be one of matching, demons, got 'snake'"),
        ({"tension": 1.5}, "tension must be a number from 0 to 1, got 1.5"),
        ({"renew_every": 0}, "renew_every must be a whole number from 1 to 1000000, got 0"),
        ({"kind": "mask"}, "kind must be one of auto, stack, labels, got 'mask'"),
        ({"layers": 3, "depth_um": 1.0}, "layers and depth_um exclude each other"),
        ({"speed": 3}, "no parameter 'speed'"),
    ],
)
def test_parameters_out_of_range(values: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        parameters_from(values, None, MovieParameters)


def test_a_depth_needs_a_pixel_size(masks: Path) -> None:
    with pytest.raises(ParameterError, match=r"depth_um.*pixel size"):
        open_movie(masks, None, SMALL.model_copy(update={"depth_um": 1.0}))


def test_frame_intervals_that_differ(tmp_path: Path) -> None:
    paths = []
    for name, interval in (("masks", 5.0), ("signal", 10.0)):
        metadata = {"axes": "TYX", "TimeIncrement": interval, "TimeIncrementUnit": "s"}
        path = tmp_path / f"{name}.ome.tif"
        tifffile.imwrite(path, MASKS, metadata=metadata, photometric="minisblack", ome=True)
        paths.append(path)
    with pytest.raises(SignalError, match=r"frame intervals differ.*10 s.*5 s"):
        open_movie(paths[0], paths[1], SMALL)
    given = SMALL.model_copy(update={"frame_interval_s": 10.0})
    assert open_movie(paths[0], paths[1], given).scale.frame_interval_s == 10.0


def test_an_output_folder_that_is_taken(tmp_path: Path, masks: Path) -> None:
    (tmp_path / "file").write_text("mine")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "thesis.txt").write_text("years of work")
    inputs = open_movie(masks, None, SMALL)
    for name, words in (
        ("file", "is a file: pass a folder"),
        ("folder", "holds no study: pass another folder"),
    ):
        with pytest.raises(StudyError, match=words):
            movie_study(inputs, tmp_path / name)
    assert (tmp_path / "folder" / "thesis.txt").read_text() == "years of work"
    assert not list((tmp_path / "folder").glob(".*"))


@pytest.mark.parametrize("name", ["gone.tif", "words.tif", "short.tif"])
def test_a_file_that_cannot_be_read(tmp_path: Path, masks: Path, name: str) -> None:
    (tmp_path / "words.tif").write_text("layers,sectors\n")
    (tmp_path / "short.tif").write_bytes(masks.read_bytes()[:-300])
    for files in ((tmp_path / name, None), (masks, tmp_path / name)):
        with pytest.raises(CytodiskError, match=name):
            open_movie(*files, SMALL)


def test_a_file_cut_short_anywhere_never_gives_a_wrong_frame(tmp_path: Path, masks: Path) -> None:
    """Either the file is refused, or what is lost is a damaged frame."""
    whole, short = masks.read_bytes(), tmp_path / "short.tif"
    refused = lost = 0
    for kept in range(0, len(whole) - 1, 11):
        short.write_bytes(whole[:kept])
        try:
            file = open_frames(short)
        except ReadError:
            refused += 1
            continue
        assert file.n_frames == FRAMES
        frames = [read_frame(file, time) for time in range(FRAMES)]
        for frame, known in zip(frames, MASKS, strict=True):
            lost += isinstance(frame, ReadError)
            assert isinstance(frame, ReadError) or (frame == known).all()
        assert isinstance(frames[-1], ReadError)
    assert refused > 50
    assert lost > 10


def test_a_cell_that_fills_the_image_has_no_edge_that_moves(tmp_path: Path) -> None:
    study = ran(tmp_path, np.ones_like(MASKS))
    assert study.cells["status"].tolist() == ["ok"] * FRAMES
    assert study.cells["touches_border"].all()
    assert set(study.edge["status"]) == {"on the image's border", "last frame"}
    assert study.edge["velocity"].isna().all()


@pytest.mark.parametrize("side", [1, 2])
def test_a_cell_of_a_few_pixels_has_no_empty_window(tmp_path: Path, side: int) -> None:
    values = np.zeros_like(MASKS)
    values[:, 20 : 20 + side, 20 : 20 + side] = 1
    study = ran(tmp_path, values, COUNTS)
    assert study.cells["status"].tolist() == ["ok"] * FRAMES
    assert (study.windows["area"] > 0).all()
    assert study.windows["mean"].notna().all()
    velocity = study.edge.loc[study.edge["frame"] < FRAMES - 1, "velocity"]
    np.testing.assert_allclose(velocity, 0.0, atol=1e-5)


def test_a_stack_is_not_said_to_be_linked(masks: Path) -> None:
    inputs = open_movie(masks, None, SMALL.model_copy(update={"link": True}))
    assert "linked" not in inputs.understood["masks"]


@pytest.fixture
def named(tmp_path: Path) -> Any:
    """Writes a signal with names of channels; gives its path."""

    def write(*names: str) -> Path:
        metadata = {"axes": "TCYX", "Channel": {"Name": list(names)}}
        path, counts = tmp_path / "named.ome.tif", COUNTS[:, : len(names)]
        tifffile.imwrite(path, counts, photometric="minisblack", ome=True, metadata=metadata)
        return path

    return write


def test_given_names_overrule_those_of_the_file(tmp_path: Path, masks: Path, named: Any) -> None:
    given = SMALL.model_copy(update={"channels": ("Rac1", "RhoA")})
    study = movie_study(open_movie(masks, named("488", "velocity"), given), tmp_path / "out")
    assert study.activity(0)["channel"].to_numpy().tolist() == ["Rac1", "RhoA"]
    assert set(study.windows["channel"]) == {"Rac1", "RhoA"}
    assert study.provenance["parameters"]["channels"] == ["Rac1", "RhoA"]
    assert "channels Rac1, RhoA" in study.provenance["inputs"]["signal"]["read as"]
    again = parameters_from({}, study.path / "parameters.toml", MovieParameters)
    assert again == given


@pytest.mark.parametrize("opened", [open_movie, open_inputs])
def test_names_that_are_not_those_of_the_channels(masks: Path, named: Any, opened: Any) -> None:
    given = SMALL.model_copy(update={"channels": ("Rac1", "RhoA", "Cdc42")})
    words = (
        r"channels must be as many names as .*named\.ome\.tif has channels, which are 2 .*, got 3 \('Rac1', "
    )
    with pytest.raises(ParameterError, match=words):
        opened(masks, named("a", "b"), given)
    with pytest.raises(ParameterError, match=r"channels.*no signal"):
        opened(masks, None, given)


@pytest.mark.parametrize("opened", [open_movie, open_inputs])
@pytest.mark.parametrize("name", ["velocity", "velocity_cell_frame"])
def test_a_channel_with_the_name_of_the_velocity(masks: Path, named: Any, opened: Any, name: str) -> None:
    words = f"named.ome.tif has a channel '{name}', which is the name of the edge's velocity: .* --channels"
    with pytest.raises(SignalError, match=words):
        opened(masks, named("Rac1", name), SMALL)


@pytest.mark.skipif(sys.platform == "win32", reason="links take rights there")
@pytest.mark.parametrize("part", ["masks", "signal"])
def test_a_link_in_a_circle_is_a_frame_that_cannot_be_read(tmp_path: Path, part: str) -> None:
    for name in ("masks", "signal"):
        (tmp_path / name).mkdir()
        for number in range(3):
            tifffile.imwrite(tmp_path / name / f"t{number}.tif", np.ones((4, 4), np.uint8))
    link = tmp_path / part / "t1.tif"
    link.unlink()
    link.symlink_to(link)
    (note,) = open_movie(tmp_path / "masks", tmp_path / "signal", SMALL).notes
    assert f"{link} cannot be read" in note
