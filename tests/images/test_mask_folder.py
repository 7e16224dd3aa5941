import os
import pickle
import re
from pathlib import Path

import imageio.v3 as imageio
import numpy as np
import pytest
import tifffile
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.testing import assert_array_equal

from cytodisk.errors import MaskError, ReadError
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.formats.npy import read_npy
from cytodisk.images.mask_files import MaskSource, open_mask_files, read_source_cells
from cytodisk.images.mask_names import base_name

LABELS = np.zeros((30, 40), dtype=np.uint16)
LABELS[2:12, 3:10], LABELS[15:28, 20:33] = 4, 9


class Harmful:
    """Would run a command if it were unpickled as pickles usually are."""

    def __init__(self, target: Path):
        self.target = target

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.mkdir, (str(self.target),)


def save_seg(path: Path, masks: object, **more: object) -> None:
    content = {"masks": masks, "outlines": LABELS, "filename": "a.png", "diameter": np.float64(3.5), **more}
    np.save(path, content, allow_pickle=True)  # as Cellpose does


def fill(folder: Path, *names: str) -> None:
    for name in names:
        if name.endswith(".npy"):
            save_seg(folder / name, LABELS)
        elif name.lower().endswith((".tif", ".tiff")):
            tifffile.imwrite(folder / name, LABELS)
        elif name.endswith(".png"):
            imageio.imwrite(folder / name, LABELS)
        else:
            (folder / name).write_text("no image")


def test_exports_of_ilastik_are_known_by_their_names(tmp_path: Path) -> None:
    wanted = ["a_Object Identities.tif", "b_Simple Segmentation.png"]
    fill(tmp_path, *wanted, "a.tif", "b.tif", "a_Simple Segmentation.tif", "b_Probabilities.tif")
    found = open_mask_files(tmp_path)
    assert names(found) == wanted


def names(sources: tuple[MaskSource, ...]) -> list[str]:
    return [source.name for source in sources]


def test_every_pattern_is_found_and_nothing_else(tmp_path: Path) -> None:
    wanted = ["a_masks.tif", "b_masks.tiff", "c_masks.png", "d_cp_masks.png", "e_cp_masks.tif", "f_seg.npy"]
    fill(tmp_path, *wanted, "a.tif", "c_img.png", "f_flows.tif", "notes.txt", ".g_masks.tif")
    (tmp_path / "more").mkdir()
    fill(tmp_path / "more", "h_masks.tif")
    sources = open_mask_files(tmp_path)
    assert names(sources) == wanted
    cells = list(read_source_cells(sources))
    assert [cell.cell for cell in cells] == list(range(12))
    assert [cell.source for cell in cells] == [name for name in wanted for _ in range(2)]
    assert [cell.label for cell in cells] == [4, 9] * 6


def test_numbers_in_names_count_as_numbers(tmp_path: Path) -> None:
    fill(tmp_path, "a10_masks.tif", "a9_masks.png", "A11_masks.TIF", "a9b2_masks.tif")
    assert names(open_mask_files(tmp_path)) == [
        "a9_masks.png",
        "a9b2_masks.tif",
        "a10_masks.tif",
        "A11_masks.TIF",
    ]


def test_no_cell_is_counted_twice(tmp_path: Path) -> None:
    fill(tmp_path, "a_seg.npy", "a_cp_masks.png", "a_masks.tif", "b_seg.npy", "b_cp_masks.tif", "c_seg.npy")
    sources = open_mask_files(tmp_path)
    assert names(sources) == ["a_masks.tif", "b_cp_masks.tif", "c_seg.npy"]
    assert [source.instead_of for source in sources] == [("a_cp_masks.png", "a_seg.npy"), ("b_seg.npy",), ()]


@pytest.mark.parametrize(
    ("name", "base"),
    [
        ("a_masks.tif", "a"),
        ("a_cp_masks.png", "a"),
        ("a.b_seg.npy", "a.b"),
        ("A_MASKS.TIF", "A"),
        ("a.b.tif", "a.b"),
    ],
)
def test_the_image_that_masks_belong_to(name: str, base: str) -> None:
    assert base_name(name) == base


def test_a_folder_without_known_names_has_every_image(tmp_path: Path) -> None:
    fill(tmp_path, "2.tif", "10.png", "readme.txt")
    assert names(open_mask_files(tmp_path)) == ["2.tif", "10.png"]


def test_a_folder_without_images(tmp_path: Path) -> None:
    fill(tmp_path, "readme.txt", ".hidden.tif")
    with pytest.raises(ReadError, match=r"no masks.*_masks\.tif"):
        open_mask_files(tmp_path)


def test_a_path_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="does not exist"):
        open_mask_files(tmp_path / "none")


def test_a_file_that_cannot_be_used_has_its_fault_and_its_cell(tmp_path: Path) -> None:
    fill(tmp_path, "a_masks.tif", "c_masks.tif")
    (tmp_path / "b_masks.tif").write_bytes((tmp_path / "a_masks.tif").read_bytes()[:100])
    imageio.imwrite(tmp_path / "d_masks.png", np.zeros((5, 5, 3), np.uint8))
    cells = list(read_source_cells(open_mask_files(tmp_path)))
    assert [cell.source[0] for cell in cells] == ["a", "a", "b", "c", "c", "d"]
    assert isinstance(cells[2].fault, ReadError)
    assert isinstance(cells[5].fault, MaskError)
    assert "3 channels" in str(cells[5].fault)
    assert all(cell.fault is None for cell in (*cells[:2], *cells[3:5]))


def test_a_single_file_that_cannot_be_used_is_an_error(tmp_path: Path) -> None:
    imageio.imwrite(tmp_path / "d.png", np.zeros((5, 5, 3), np.uint8))
    with pytest.raises(MaskError, match="3 channels"):
        open_mask_files(tmp_path / "d.png")


def test_a_file_of_zeros_and_ones_is_one_mask(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a_masks.tif", (LABELS == 4).astype(np.uint8))
    (source,) = open_mask_files(tmp_path)
    (cell,) = read_source_cells([source])
    assert (source.kind, cell.label, cell.corner, cell.image_shape) == ("mask", 1, (1, 2), (30, 40))
    assert_array_equal(cell.mask, LABELS[1:13, 2:11] == 4)


@given(
    arrays.arrays(
        np.uint8, arrays.array_shapes(min_dims=2, max_dims=2, max_side=9), elements=st.integers(0, 3)
    ),
    st.sampled_from([1, 7_000, 3_000_000_000]),
)
def test_a_crop_holds_its_cell_and_a_margin_where_the_image_goes_on(
    tmp_path_factory: pytest.TempPathFactory, image: np.ndarray, factor: int
) -> None:
    path = tmp_path_factory.mktemp("labels") / "a.npy"
    labels = image.astype(np.uint64) * np.uint64(factor)
    np.save(path, labels)
    how = KindParameters(kind="labels", fragments="largest")
    cells = list(read_source_cells(open_mask_files(path, how)))
    if not image.any():
        assert "holds no label" in str(cells[0].fault)
        return
    assert [cell.label for cell in cells] == np.unique(labels[labels != 0]).tolist()
    for cell in cells:
        assert cell.mask is not None
        whole = np.zeros(image.shape, dtype=bool)
        y, x = cell.corner
        height, width = cell.mask.shape
        whole[y : y + height, x : x + width] = cell.mask
        assert_array_equal(whole, labels == np.uint64(cell.label))
        at_border = [whole[0], whole[-1], whole[:, 0], whole[:, -1]]
        at_crop = [cell.mask[0], cell.mask[-1], cell.mask[:, 0], cell.mask[:, -1]]
        assert [side.any() for side in at_crop] == [side.any() for side in at_border]


def test_cellposes_file_holds_its_masks(tmp_path: Path) -> None:
    save_seg(tmp_path / "a_seg.npy", np.asfortranarray(LABELS), flows=[LABELS / 3, None], ismanual=LABELS > 4)
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)


@pytest.mark.parametrize("protocol", [2, 3, 4])
def test_older_pickles_are_read(tmp_path: Path, protocol: int) -> None:
    save_seg(tmp_path / "a_seg.npy", LABELS)
    head = (tmp_path / "a_seg.npy").read_bytes()[:128]
    content = np.empty((), dtype=object)
    content[()] = {"masks": LABELS.astype(">u2"), "who": np.array(["a", "bc"]), "n": np.int32(3)}
    (tmp_path / "a_seg.npy").write_bytes(head + pickle.dumps(content, protocol=protocol))
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)


@pytest.mark.parametrize("hidden_in", ["masks", "filename"])
def test_a_file_that_would_run_code_is_refused_and_runs_nothing(tmp_path: Path, hidden_in: str) -> None:
    harmful = Harmful(tmp_path / "proof")
    content = {"masks": LABELS, "filename": "a.png"} | {hidden_in: harmful}
    np.save(tmp_path / "a_seg.npy", content, allow_pickle=True)
    fill(tmp_path, "b_masks.tif")
    bad, good = open_mask_files(tmp_path)
    assert re.search("asks for (posix|nt).mkdir when it is read: a file must not run code", str(bad.fault))
    assert good.fault is None
    assert not (tmp_path / "proof").exists()
    np.load(tmp_path / "a_seg.npy", allow_pickle=True)  # the trap is a real one
    assert (tmp_path / "proof").exists()


@pytest.mark.parametrize("content", [{"flows": LABELS}, {"masks": [1, 2]}, [LABELS], {"masks": None}])
def test_a_file_without_label_image(tmp_path: Path, content: object) -> None:
    array = np.empty((), dtype=object)
    array[()] = content
    np.save(tmp_path / "a_seg.npy", array, allow_pickle=True)
    (source,) = open_mask_files(tmp_path)
    assert "holds no label image: a `_seg.npy` of Cellpose has an array named 'masks'" in str(source.fault)


def test_a_seg_file_cut_short_is_unreadable(tmp_path: Path) -> None:
    fill(tmp_path, "a_seg.npy")
    content = (tmp_path / "a_seg.npy").read_bytes()
    (tmp_path / "a_seg.npy").write_bytes(content[: len(content) // 2])
    (source,) = open_mask_files(tmp_path)
    assert isinstance(source.fault, ReadError)


@pytest.mark.parametrize(
    ("array", "words"),
    [
        (np.zeros((4, 5), dtype=[("a", "i4"), ("b", "f8")]), "has the type .*'a'"),
        (np.ones((4, 5), dtype=complex), "has the type complex128: save an array of numbers"),
        (np.ones((4, 5), dtype="datetime64[s]"), "has the type datetime64"),
        (np.full((4, 5), "a"), "has the type <U1"),
    ],
)
def test_an_array_without_numbers_costs_its_own_file_alone(
    tmp_path: Path, array: np.ndarray, words: str
) -> None:
    np.save(tmp_path / "a_seg.npy", array)
    fill(tmp_path, "b_masks.tif")
    bad, good = open_mask_files(tmp_path)
    assert isinstance(bad.fault, ReadError)
    assert re.search(words, str(bad.fault))
    assert good.fault is None


def test_labels_that_no_table_can_hold_are_refused(tmp_path: Path) -> None:
    for name, factor in (("a", 2**63 + 5), ("b", 2**63 - 1), ("c", 2**64 - 1)):
        np.save(tmp_path / f"{name}.npy", (LABELS == 4).astype(np.uint64) * np.uint64(factor))
    for kind in ("auto", "labels"):
        (cell,) = read_source_cells(open_mask_files(tmp_path / "a.npy", KindParameters(kind=kind)))
        assert isinstance(cell.fault, MaskError)
        assert "has labels up to 9223372036854775813: number the cells from 1" in str(cell.fault)
    (cell,) = read_source_cells(open_mask_files(tmp_path / "b.npy"))
    assert (cell.fault, cell.label) == (None, 2**63 - 1)
    (cell,) = read_source_cells(open_mask_files(tmp_path / "c.npy"))  # as 0 and 255 in 8 bits
    assert (cell.fault, cell.label) == (None, 1)
    (cell,) = read_source_cells(open_mask_files(tmp_path / "c.npy", KindParameters(kind="labels")))
    assert "number the cells from 1" in str(cell.fault)


class Calls:
    """Is pickled as a call of something harmless but large."""

    def __init__(self, kind: type, *with_: object):
        self.call = kind, with_

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return self.call


@pytest.mark.parametrize(
    "large",
    [
        Calls(set, Calls(range, 2**60)),
        Calls(frozenset, Calls(range, 2**60)),
        Calls(bytearray, 2**60),
        Calls(range, 2**60),
    ],
)
def test_no_container_is_filled_because_a_file_says_so(tmp_path: Path, large: Calls) -> None:
    np.save(tmp_path / "a_seg.npy", {"masks": LABELS, "more": large}, allow_pickle=True)
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)


def test_a_number_in_the_place_of_bytes_is_a_fault(tmp_path: Path) -> None:
    scalar = np.float64(1).__reduce__()[0]
    large = Calls(scalar, np.dtype("u1"), 2**60)  # type: ignore[arg-type]
    np.save(tmp_path / "a_seg.npy", {"masks": LABELS, "more": large}, allow_pickle=True)
    (source,) = open_mask_files(tmp_path)
    assert "has int where its bytes are due" in str(source.fault)


def test_want_of_memory_is_a_fault_of_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_room(path: Path) -> np.ndarray:
        raise MemoryError

    fill(tmp_path, "a_seg.npy")
    monkeypatch.setattr("cytodisk.images.formats.array_file.read_npy", no_room)
    (source,) = open_mask_files(tmp_path)
    assert "a_seg.npy: its header asks for more memory than there is" in str(source.fault)


def test_reasons_stand_on_one_line(tmp_path: Path) -> None:
    class Pickler(pickle.Pickler):
        def persistent_id(self, obj: object) -> str | None:
            return "x" if obj == "persistent" else None

    save_seg(tmp_path / "a_seg.npy", LABELS)
    head = (tmp_path / "a_seg.npy").read_bytes()[:128]
    with (tmp_path / "a_seg.npy").open("wb") as file:
        file.write(head)
        Pickler(file).dump({"masks": "persistent"})
    (source,) = open_mask_files(tmp_path)
    assert "persistent" in str(source.fault)
    assert "\n" not in str(source.fault)


def test_masks_of_a_z_stack_are_refused(tmp_path: Path) -> None:
    save_seg(tmp_path / "a_seg.npy", np.stack([LABELS] * 3))
    (source,) = open_mask_files(tmp_path)
    assert "is a z-stack (axes ZYX, shape (3, 30, 40)): project it" in str(source.fault)


def test_a_good_file_stands_in_for_a_damaged_one(tmp_path: Path) -> None:
    fill(tmp_path, "a_masks.png", "a_seg.npy", "b_masks.tif", "b_seg.npy", "c_masks.tif", "c_seg.npy")
    for name in ("a_masks.png", "c_masks.tif", "c_seg.npy"):
        content = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(content[: len(content) // 2])
    for kind in ("auto", "labels"):
        a, b, c = open_mask_files(tmp_path, KindParameters(kind=kind))
        assert (a.name, a.fault, a.instead_of, a.damaged) == (
            "a_seg.npy",
            None,
            ("a_masks.png",),
            ("a_masks.png",),
        )
        assert (b.name, b.fault, b.instead_of, b.damaged) == ("b_masks.tif", None, ("b_seg.npy",), ())
        assert (c.name, c.instead_of, c.damaged) == ("c_masks.tif", ("c_seg.npy",), ())
        assert isinstance(c.fault, ReadError)


@pytest.mark.skipif(os.name == "nt", reason="links need a right there")
def test_a_link_that_leads_nowhere_is_a_fault(tmp_path: Path) -> None:
    fill(tmp_path, "a_masks.tif")
    (tmp_path / "b_masks.tif").symlink_to("gone.tif")
    good, bad = open_mask_files(tmp_path)
    assert good.fault is None
    assert "b_masks.tif is a link to a file that is not there: gone.tif" in str(bad.fault)


def test_images_beside_plain_masks_are_no_masks(tmp_path: Path) -> None:
    fill(tmp_path, "a.tif", "a_img.tif", "b.tif", "b_img.png")
    assert names(open_mask_files(tmp_path, images=("_img",))) == ["a.tif", "b.tif"]
    assert names(open_mask_files(tmp_path, images=("_img.png",))) == ["a.tif", "a_img.tif", "b.tif"]
    (tmp_path / "a.tif").unlink()
    (tmp_path / "b.tif").unlink()
    with pytest.raises(ReadError, match="holds no masks"):
        open_mask_files(tmp_path, images=("_img",))


@pytest.mark.parametrize("dtype", [np.uint8, bool, np.float32])
def test_an_image_without_a_cell_has_the_label_0(tmp_path: Path, dtype: type) -> None:
    np.save(tmp_path / "a.npy", np.zeros((4, 5), dtype=dtype))
    (cell,) = read_source_cells(open_mask_files(tmp_path / "a.npy"))
    assert cell.label == 0


def test_a_folder_of_arrays_holds_masks_as_one_of_pictures_does(tmp_path: Path) -> None:
    mask = np.zeros((20, 20), np.uint8)
    mask[5:15, 5:15] = 1
    for number in (10, 2):
        np.save(tmp_path / f"m{number}.npy", mask)
    assert [source.name for source in open_mask_files(tmp_path)] == ["m2.npy", "m10.npy"]
    assert [cell.fault for cell in read_source_cells(open_mask_files(tmp_path))] == [None, None]
