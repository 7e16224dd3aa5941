import re
from pathlib import Path

import pytest

from cytodisk.errors import ReadError, SignalError
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.signal_files import common_name, pair_images


def sources(folder: Path, *names: str) -> list[MaskSource]:
    return [MaskSource(name, folder / name, None, None) for name in names]


def fill(folder: Path, *names: str) -> Path:
    folder.mkdir(exist_ok=True)
    for name in names:
        (folder / name).touch()
    return folder


@pytest.mark.parametrize(
    ("mask", "image"),
    [
        ("img_001_masks.tif", "img_001.tif"),
        ("img_001_cp_masks.png", "img_001.ome.tif"),
        ("img_001_seg.npy", "img_001.png"),
        ("000_masks.png", "000_img.png"),
        ("img_001.tif", "img_001.tiff"),
        ("img_001_Simple Segmentation.tif", "img_001.tif"),
        ("img_001_Object Identities.tiff", "img_001.png"),
    ],
)
def test_images_pair_by_name(tmp_path: Path, mask: str, image: str) -> None:
    images = fill(tmp_path / "images", image, "img_0011.tif", "img.tif", ".img_001.tif")
    assert pair_images(sources(tmp_path, mask), images) == (images / image,)


@pytest.mark.parametrize("signal", ["_w1", "_w1.tif"])
@pytest.mark.parametrize("elsewhere", [False, True])
def test_how_names_go_on(tmp_path: Path, signal: str, elsewhere: bool) -> None:
    folder = fill(tmp_path / "b" if elsewhere else tmp_path, "a_w1.tif", "a_w2.tif", "a.tif", "c_w1.tif")
    given = folder / signal if elsewhere else signal
    found = pair_images(sources(tmp_path, "a_masks.tif", "c_seg.npy"), given)
    assert found == (folder / "a_w1.tif", folder / "c_w1.tif")


def test_a_dot_alone_is_the_name_itself(tmp_path: Path) -> None:
    fill(tmp_path, "a.tif", "a_masks.tif", "a_w1.tif")
    assert pair_images(sources(tmp_path, "a_masks.tif"), ".tif") == (tmp_path / "a.tif",)


def test_a_mask_is_never_its_own_image(tmp_path: Path) -> None:
    fill(tmp_path, "a.tif", "b.tif", "b_img.tif")
    first, second = pair_images(sources(tmp_path, "a.tif", "b.tif"), tmp_path)
    assert isinstance(first, SignalError)
    assert second == tmp_path / "b_img.tif"


def test_a_missing_and_an_ambiguous_pair_say_so(tmp_path: Path) -> None:
    images = fill(tmp_path / "images", "b.tif", "b_img.png", "c.tif")
    masks = sources(tmp_path, "a_masks.tif", "b_masks.tif", "c_masks.tif")
    missing, ambiguous, found = pair_images(masks, images)
    assert f"a_masks.tif has no image in {images}: a.tif or a_img.tif" in str(missing)
    assert f"b_masks.tif has several images in {images} (b.tif, b_img.png)" in str(ambiguous)
    assert found == images / "c.tif"


def test_what_cannot_be_paired_at_all(tmp_path: Path) -> None:
    masks = sources(tmp_path, "a_masks.tif")
    with pytest.raises(SignalError, match=r"fits no mask file: a_masks\.tif has no image"):
        pair_images(masks, fill(tmp_path / "images"))
    with pytest.raises(SignalError, match=r"fits no mask file: a_masks\.tif has no image"):
        pair_images(masks, "_img")
    with pytest.raises(SignalError, match="one file for a folder of masks"):
        pair_images(masks, fill(tmp_path / "one", "a.tif") / "a.tif")
    with pytest.raises(ReadError, match="gone does not exist"):
        pair_images(masks, "gone")


@pytest.mark.parametrize(
    ("mask", "image", "signal", "words"),
    [
        ("a_cp_masks.png", "a.tif", "_img", "but a.tif is: pass --signal {folder}$"),
        ("a_seg.npy", "a_w1.tif", "_img", "but a_w1.tif is: pass --signal _w1.tif$"),
        ("a_masks.tif", "a_w1.tif", "images", "but a_w1.tif is: pass --signal {images}/_w1.tif$"),
        ("mask0001.tif", "vasp0001.tif", "images", "vasp0001.tif and others .*, use cytodisk movie$"),
        ("a_masks.tif", "b_masks.tif", "_img", "[)] is not there$"),
    ],
)
def test_where_no_image_fits_the_message_says_what_to_type(
    tmp_path: Path, mask: str, image: str, signal: str, words: str
) -> None:
    images = tmp_path / "images"
    fill(tmp_path, mask)
    fill(images if signal == "images" else tmp_path, image)
    given = images if signal == "images" else signal
    words = words.format(folder=re.escape(str(tmp_path)), images=re.escape(str(images)))
    with pytest.raises(SignalError, match=words) as caught:
        pair_images(sources(tmp_path, mask), given)
    if "--signal" in (message := str(caught.value)):  # what it says works
        assert pair_images(sources(tmp_path, mask), message.rsplit("--signal ")[-1])[0].name == image


@pytest.mark.parametrize(
    ("signal", "name"),
    [(".tif", "signal"), ("*.tif", "signal"), (".ome.tif", "signal"), ("_w1.tif", "w1"), ("*_w1.tif", "w1")],
)
def test_the_channel_of_many_images_is_not_called_after_their_format(signal: str, name: str) -> None:
    assert common_name(Path(signal)) == name
