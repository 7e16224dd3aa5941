"""Arrays of an `.npz` file that somebody edited: each fault names the file, the array and what to do."""

import zipfile
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from cytodisk.array_archive import reading_arrays
from cytodisk.errors import ReadError


def _with_entry(path: Path, content: bytes, how: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", how) as archive:
        archive.writestr("a.npy", content)
    return path


def _npy(array: np.ndarray) -> bytes:
    content = BytesIO()
    np.save(content, array)
    return content.getvalue()


def _floats(path: Path) -> np.ndarray:
    with reading_arrays(path, "a file of arrays", "make it again") as archive:
        return archive.floats("a", (None,), low=-10.0, high=10.0)


@pytest.mark.parametrize("kind", ["<f8", ">f8", "<f4", "<f2"])
def test_numbers_of_any_precision_and_byte_order_are_read(tmp_path: Path, kind: str) -> None:
    values = np.array([-1.5, 0.0, 2.25], dtype=kind)
    found = _floats(_with_entry(tmp_path / "a.npz", _npy(values)))
    assert found.dtype == np.float64
    assert found.flags.writeable
    assert found.tolist() == values.tolist()


def test_columns_first_is_read_in_order(tmp_path: Path) -> None:
    values = np.asfortranarray(np.arange(6).reshape(2, 3))
    path = _with_entry(tmp_path / "a.npz", _npy(values))
    with reading_arrays(path, "a file of arrays", "make it again") as archive:
        assert archive.integers("a", (2, None), least=0, most=5).tolist() == values.tolist()


def _claiming(shape: str) -> bytes:
    """An array of 24 bytes whose header says another shape."""
    content = _npy(np.zeros(3))
    return content.replace(b"'shape': (3,), }" + b" " * len(shape), f"'shape': {shape}, }}    ".encode())


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is no array"),
        (b"\x93NUMPY\x01\x00", "is no array"),
        (_npy(np.zeros(3)).replace(b"'<f8'", b"'|O8'"), "is no array"),
        (_npy(np.array(["a", "b"])), "has dtype <U1, not numbers"),
        (_npy(np.zeros((3, 1))), r"has shape \(3, 1\), not any number"),
        (_npy(np.zeros(3)) + bytes(8), "another number of bytes"),
        (_npy(np.zeros(3))[:-1], "another number of bytes"),
        (_claiming("(99999999999999,)"), "another number of bytes"),
        (_npy(np.array([0.0, np.inf])), "has inf"),
        (_npy(np.array([0.0, np.nan])), "has nan"),
        (_npy(np.array([11.0])), "has 11.0, where -10 to 10 can be"),
    ],
)
def test_what_is_not_as_it_must_be_is_named(tmp_path: Path, content: bytes, words: str) -> None:
    path = _with_entry(tmp_path / "a.npz", content)
    with pytest.raises(ReadError, match=rf"a\.npz: a .*{words}.*: make it again$"):
        _floats(path)


def test_a_bomb_is_not_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = _with_entry(tmp_path / "a.npz", _npy(np.zeros(20_000_000)))
    assert path.stat().st_size < 1_000_000
    monkeypatch.setattr("cytodisk.array_archive.free_bytes", lambda: 300_000_000)
    with pytest.raises(ReadError, match=r"a asks for 0\.2 GB, more than half of the free memory"):
        _floats(path)


def test_an_entry_that_lies_of_its_length_is_refused(tmp_path: Path) -> None:
    content = _npy(np.zeros(1000))
    path = _with_entry(tmp_path / "a.npz", content)
    told = len(content).to_bytes(4, "little")
    shape = b"'shape': (1000,), }"
    raw = path.read_bytes()
    assert raw.count(told) == 2
    _with_entry(path, content.replace(shape + b" " * 6, b"'shape': (1000000000,), }"))
    lying = (128 + 8 * 10**9).to_bytes(8, "little")[:4]
    path.write_bytes(path.read_bytes().replace(told, lying))
    with pytest.raises(ReadError, match=r"a\.npz"):
        _floats(path)


def test_bytes_that_are_neither_true_nor_false_are_refused(tmp_path: Path) -> None:
    content = _npy(np.array([True, False])).replace(b"\x01\x00", b"\x01\x07")
    content = b"\x93NUMPY\x01\x00" + content[8:]
    path = _with_entry(tmp_path / "a.npz", content)
    with (
        reading_arrays(path, "a file of arrays", "make it again") as archive,
        pytest.raises(ReadError, match="a has 7"),
    ):
        archive.truths("a", (None,), most=(2,))


def test_texts_with_what_is_no_letter_are_refused(tmp_path: Path) -> None:
    content = _npy(np.array(["ab"])).replace(b"b\x00\x00\x00", b"\xff\xff\xff\xff")
    path = _with_entry(tmp_path / "a.npz", content)
    with (
        reading_arrays(path, "a file of arrays", "make it again") as archive,
        pytest.raises(ReadError, match="a holds what is no letter"),
    ):
        archive.texts("a", (None,))


def test_a_missing_array_a_folder_and_a_missing_file_are_named(tmp_path: Path) -> None:
    path = _with_entry(tmp_path / "a.npz", _npy(np.zeros(1)))
    with (
        reading_arrays(path, "a file of arrays", "make it again") as archive,
        pytest.raises(ReadError, match=r"a\.npz: b is missing: make it again"),
    ):
        archive.numbers("b", ())
    for place, words in ((tmp_path, "is no file"), (tmp_path / "c.npz", "does not exist")):
        with pytest.raises(ReadError, match=words):
            _floats(place)
