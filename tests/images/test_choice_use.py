from pathlib import Path

import numpy as np
import pytest
import tifffile

from cytodisk.errors import ParameterError
from cytodisk.images.choice_use import check_choice
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames, read_image


@pytest.fixture
def stack(tmp_path: Path) -> Path:
    """A z-stack of 4 slices."""
    path = tmp_path / "stack.ome.tif"
    tifffile.imwrite(path, np.arange(4 * 600, dtype=np.uint16).reshape(4, 20, 30), metadata={"axes": "ZYX"})
    return path


@pytest.fixture
def two(tmp_path: Path) -> Path:
    """Two images, the second with the name "right"."""
    path = tmp_path / "two.ome.tif"
    with tifffile.TiffWriter(path) as tiff:
        for value, name in enumerate(("left", "right")):
            tiff.write(np.full((3, 20, 30), value, np.uint8), metadata={"axes": "TYX", "Name": name})
    return path


def test_files_offer_what_there_is_to_choose(tmp_path: Path, stack: Path, two: Path) -> None:
    np.save(tmp_path / "one.npy", np.zeros((20, 30), np.uint8))
    choice = FileChoice(scene="1", z="2")
    files = [open_frames(path, choice=choice) for path in (stack, two, tmp_path / "one.npy")]
    assert [file.offers for file in files] == [("z",), ("scene",), ()]
    assert files[0].frame(0).min() == 1200
    assert files[1].frame(0).min() == 1
    check_choice(files, "1", "2")
    check_choice([], "1", None)


@pytest.mark.parametrize(
    ("scene", "z", "said"),
    [
        (
            "1",
            "2",
            r"--scene 1 chooses nothing: .* several scenes \(stack.ome.tif\); leave out --scene",
        ),
        ("right", None, "--scene right chooses nothing"),
    ],
)
def test_a_choice_that_no_file_offers_is_refused(stack: Path, scene: str, z: str | None, said: str) -> None:
    file = open_frames(stack, choice=FileChoice(z="2"))
    with pytest.raises(ParameterError, match=said):
        check_choice([file, None], scene, z)


def test_the_same_from_python(stack: Path, two: Path) -> None:
    with pytest.raises(ParameterError, match=r"^z max chooses nothing: .*\(two.ome.tif\); leave out z$"):
        read_image(two, scene="right", z="max")
    assert read_image(stack, z="max").values.min() == 1800
