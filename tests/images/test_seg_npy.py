"""Objects in a `_seg.npy` that are no part of the masks."""

import collections
import datetime
import decimal
import enum
import pathlib
import pickle
import types
import uuid
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_array_equal

from cytodisk.errors import ReadError
from cytodisk.images.formats.npy import read_npy
from cytodisk.images.frames import open_frames

LABELS = np.zeros((30, 40), dtype=np.uint16)
LABELS[2:12, 3:10], LABELS[15:28, 20:33] = 4, 9


class Colour(enum.Enum):
    RED = 1


class Slotted:
    __slots__ = ("a",)

    def __init__(self) -> None:
        self.a = 1


class Names(list[str]):
    """A list of a kind of its own."""


OTHERS = [
    pathlib.PurePosixPath("/data/a.tif"),
    [pathlib.PureWindowsPath(r"C:\data\a.tif")],
    datetime.datetime(2026, 5, 3, 12, 30, tzinfo=datetime.UTC),
    datetime.timedelta(seconds=3),
    collections.OrderedDict(a=1, b=pathlib.PurePosixPath("b")),
    collections.defaultdict(list, a=[1]),
    collections.Counter("abc"),
    collections.deque([1, 2, 3], maxlen=5),
    decimal.Decimal("1.5"),
    uuid.UUID(int=5),
    types.SimpleNamespace(a=1),
    Colour.RED,
    Slotted(),
    Names(["a", "b"]),
    {1, 2},
    3 + 4j,
    np.zeros(3, dtype=[("a", "i4"), ("b", "f8")]),
    np.array(["2026-05-03"], dtype="datetime64[D]"),
    np.datetime64("2026-05-03"),
    np.ma.masked_array([1, 2], [True, False]),
    np.random.default_rng(0),
    np.float32,
    pd.DataFrame({"a": [1.0, 2.0], "b": ["x", "y"]}),
    pd.Timestamp("2026-05-03"),
    np.add,
    len,
]


def save(path: Path, content: object, protocol: int | None = None) -> None:
    np.save(path, np.empty((), dtype=object), allow_pickle=True)
    head = path.read_bytes()[:128]
    array = np.empty((), dtype=object)
    array[()] = content
    path.write_bytes(head + pickle.dumps(array, protocol=protocol))


@pytest.mark.parametrize("protocol", [2, 4, 5])
@pytest.mark.parametrize("other", OTHERS, ids=lambda other: type(other).__name__)
def test_what_is_no_part_of_the_masks_is_left_out(tmp_path: Path, other: object, protocol: int) -> None:
    content = {"filename": other, "masks": LABELS, "more": {"of it": [other, other]}}
    save(tmp_path / "a_seg.npy", content, protocol)
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)
    assert_array_equal(open_frames(tmp_path / "a_seg.npy").frame(0)[0], LABELS)


@pytest.mark.parametrize(
    "kind", [collections.OrderedDict, lambda items: collections.defaultdict(None, items)]
)
@pytest.mark.parametrize("protocol", [2, 4])
def test_masks_in_another_kind_of_dict_are_found(tmp_path: Path, kind: type, protocol: int) -> None:
    save(tmp_path / "a_seg.npy", kind({"masks": LABELS, "diameter": 30.0}), protocol)
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)


@pytest.mark.parametrize("masks", [pathlib.PurePosixPath("a.png"), np.ma.masked_array([1, 2], [1, 0]), None])
def test_masks_that_are_no_array_are_told(tmp_path: Path, masks: object) -> None:
    save(tmp_path / "a_seg.npy", {"masks": masks})
    with pytest.raises(ReadError, match="holds no label image"):
        read_npy(tmp_path / "a_seg.npy")


class Call:
    """Is pickled as a call, and a state that is set on what it gives."""

    def __init__(self, function: object, *values: object, state: object = None):
        self.call = (function, values) if state is None else (function, values, state)

    def __reduce__(self) -> tuple[object, ...]:
        return self.call


RAN: list[str] = []


def run(*values: object) -> str:
    """A function of anybody's, which a file must not call."""
    RAN.append(str(values))
    return "ran"


@pytest.mark.parametrize(
    "harmful",
    [Call(run, 1), Call(map, run, [1]), Call(getattr, RAN, "append"), Call(type(RAN).append, RAN, 1)],
)
def test_nothing_that_a_file_names_is_called(tmp_path: Path, harmful: object) -> None:
    RAN.clear()
    save(tmp_path / "a_seg.npy", {"masks": LABELS, "filename": harmful, "more": [harmful]})
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)
    assert RAN == []


@pytest.mark.parametrize("name", ["eval", "exec", "__import__", "open", "compile"])
def test_a_file_that_asks_for_commands_is_refused(tmp_path: Path, name: str) -> None:
    import builtins

    save(tmp_path / "a_seg.npy", {"masks": LABELS, "filename": Call(getattr(builtins, name), "print(1)")})
    with pytest.raises(ReadError, match=rf"asks for \w+\.{name} when it is read.* alone, as TIFF"):
        read_npy(tmp_path / "a_seg.npy")


def test_no_state_of_a_file_changes_the_reader(tmp_path: Path) -> None:
    """A pickle can set attributes on what it names, not only on what it makes."""
    scalar = np.float64(1).__reduce__()[0]
    content = pickle.dumps({"masks": LABELS, "a": np.float64(2.5)}, protocol=2)
    name = f"c{scalar.__module__}\n{scalar.__name__}\n".encode()
    harmful = name + pickle.dumps((None, {"__defaults__": (b"",)}), protocol=2)[2:-1] + b"b."
    with (tmp_path / "b_seg.npy").open("wb") as file:
        np.lib.format.write_array_header_1_0(file, {"descr": "|O", "fortran_order": False, "shape": ()})
        file.write(harmful)
    with pytest.raises(ReadError):
        open_frames(tmp_path / "b_seg.npy")
    save(tmp_path / "a_seg.npy", pickle.loads(content))
    assert_array_equal(read_npy(tmp_path / "a_seg.npy"), LABELS)
