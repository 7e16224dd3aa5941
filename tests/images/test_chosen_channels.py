"""Names of channels, and some of them taken out of a file."""

from pathlib import Path

import numpy as np
import pytest
import tifffile
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.errors import MaskError, ReadError
from cytodisk.images.chosen_channels import with_channels
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frame_pixels import frame_pixels
from cytodisk.images.frames import open_frames
from cytodisk.images.what_it_is import look_at

STACK = np.arange(3 * 2 * 20 * 31, dtype=np.uint16).reshape(3, 2, 20, 31)


def written(folder: Path, name: str, names: list[str] | None = None) -> Path:
    more = {} if names is None else {"Channel": {"Name": names}}
    tifffile.imwrite(folder / name, STACK, metadata={"axes": "TCYX"} | more, ome=".ome." in name)
    return folder / name


@pytest.mark.parametrize(
    ("name", "names", "shown", "unnamed"),
    [
        ("a.ome.tif", ["Rac1", "RhoA"], ("Rac1", "RhoA"), False),
        ("a.ome.tif", ["405", "488"], ("405", "488"), False),
        ("VASP 3.ome.tif", None, ("VASP 3 1", "VASP 3 2"), True),
        ("cell.v2.ome.tif", ["0", "1"], ("cell.v2 1", "cell.v2 2"), True),
    ],
)
def test_names_come_from_the_file_else_from_its_name(
    tmp_path: Path, name: str, names: list[str] | None, shown: tuple[str, ...], unnamed: bool
) -> None:
    file = open_frames(written(tmp_path, name, names))
    assert (file.channels, file.unnamed) == (shown, unnamed)


def test_a_single_image_is_called_after_its_file(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "actin.tif", STACK[0, 0])
    assert open_frames(tmp_path / "actin.tif").channels == ("actin",)


@pytest.mark.parametrize(
    ("wanted", "names", "planes"),
    [(("1",), ("b 2",), [1]), (("1", "0"), ("b 2", "b 1"), [1, 0]), (("b 1",), ("b 1",), [0])],
)
def test_channels_are_taken_by_name_or_number_in_the_order_that_is_wanted(
    tmp_path: Path, wanted: tuple[str, ...], names: tuple[str, ...], planes: list[int]
) -> None:
    file = open_frames(written(tmp_path, "b.ome.tif"), choice=FileChoice(channels=wanted))
    assert file.channels == names
    assert file.axes == ("TYX" if len(planes) == 1 else "TCYX")
    assert_array_equal(file.frame(2), STACK[2, planes])
    piece = frame_pixels(file, 2).cut(slice(2, 9), slice(3, 30))
    assert_array_equal(piece, STACK[2, planes, 2:9, 3:30])
    cut, _ = file.stored.by_piece(1) or (None, 0)
    assert cut is not None
    assert_array_equal(cut(slice(2, 9), slice(3, 30)), STACK[1, planes, 2:9, 3:30])


def test_a_channel_that_is_not_there_lists_those_that_are(tmp_path: Path) -> None:
    path = written(tmp_path, "a.ome.tif", ["Rac1", "RhoA"])
    for wanted in ("2", "Cdc42", "-1", "rac1"):
        with pytest.raises(cd.errors.ReadError, match=r"pass channels with one of .* 0 \(Rac1\), 1 \(RhoA\)"):
            cd.read_image(path, channels=[wanted])
    with pytest.raises(cd.errors.ReadError, match="names one channel twice"):
        cd.read_image(path, channels=["RhoA", 1])


def test_python_takes_the_same_choices(tmp_path: Path) -> None:
    path = written(tmp_path, "a.ome.tif", ["Rac1", "RhoA"])
    image = cd.read_image(path, channels=["RhoA"])
    assert (image.dims, image["channel"].item()) == (("time", "y", "x"), "RhoA")
    assert_array_equal(image, STACK[:, 1])
    with pytest.raises(cd.errors.ParameterError, match="z must be a number from 0, max or mean"):
        cd.read_image(path, z="median")


def test_the_mask_may_be_a_channel_of_its_file(tmp_path: Path) -> None:
    planes = np.stack([STACK[0, 0] * 0, np.pad(np.full((9, 9), 7, np.uint16), 11)[:20, :31]])
    tifffile.imwrite(tmp_path / "m.ome.tif", planes, metadata={"axes": "CYX"})
    with pytest.raises(cd.errors.MaskError, match="pass the channel that holds it, as --mask-channel 1"):
        cd.run_map(tmp_path / "m.ome.tif", tmp_path / "out", layers=2, sectors=4)
    study = cd.run_map(tmp_path / "m.ome.tif", tmp_path / "out", layers=2, sectors=4, mask_channel=1)
    assert study.cells["status"].tolist() == ["ok"]
    with pytest.raises(cd.errors.StudyError, match="mask_channel"):
        cd.run_map(tmp_path / "m.ome.tif", tmp_path / "out", layers=2, sectors=4, mask_channel=0, resume=True)


def test_messages_name_some_of_many_channels(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.zeros((50, 20, 30), np.uint8))
    file = open_frames(tmp_path / "a.npy", unnamed="C")
    with pytest.raises(ReadError, match=r"no channel 'GFP'.* 11 \(a 12\) and 38 more$"):
        with_channels(file, ["GFP"], "--signal-channels")
    with pytest.raises(MaskError, match=r"50 channels \(a 1, .*, a 8 and 42 more\)"):
        look_at(file)
