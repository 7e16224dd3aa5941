"""Damage done to files: to bytes, and to the structure of each format so that its checksums hold."""

import io
import json
import re
import struct
import zipfile
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.random import Generator

from fuzz_files import content_of

Mutation = Callable[[Generator, bytes], bytes]

_NUMBERS = (
    0,
    1,
    -1,
    2,
    255,
    65535,
    2**31 - 1,
    2**31,
    2**32 - 1,
    2**63 - 1,
    -(2**63),
    10**30,
    1e308,
    5e-324,
    0.5,
)
_WORDS = ("", "x", "nan", "inf", "-1", "0", "=1+1", "../../x", "\u0000", "µ" * 300, "1e400", "[]", "ok")
_BYTES = (
    b"\x00",
    b"\xff",
    b"\x7f",
    b"\x80",
    b"\xff\xff\xff\xff",
    b"\x00\x00\x00\x00",
    b"\xff\xff\xff\x7f",
    b"\x01",
)


def of_bytes(random: Generator, content: bytes) -> bytes:
    """Bytes flipped, overwritten, removed, doubled, put in or cut off."""
    if not content:
        return b"\x00"
    changed = bytearray(content)
    for _ in range(int(random.integers(1, 5))):
        place = int(random.integers(len(changed) or 1))
        length = int(min(len(changed) - place, 2 ** random.integers(0, 8)))
        match int(random.integers(7)):
            case 0 if changed:
                changed[place] ^= 1 << int(random.integers(8))
            case 1:
                piece = _one(random, _BYTES)
                changed[place : place + len(piece)] = piece
            case 2:
                del changed[place : place + length]
            case 3:
                changed[place:place] = changed[place : place + length]
            case 4:
                changed[place:place] = random.bytes(length)
            case 5:
                changed[place : place + length] = random.bytes(length)
            case _:
                del changed[place:]
        if not changed:
            return bytes(changed)
    return bytes(changed)


def of_json(random: Generator, content: bytes) -> bytes:
    """A value of a JSON text replaced, removed or put elsewhere."""
    try:
        found = json.loads(content)
    except ValueError:
        return of_bytes(random, content)
    for _ in range(int(random.integers(1, 3))):
        found = _changed_json(random, found)
    text = json.dumps(found)
    if random.random() < 0.05:
        text = text.replace("null", "NaN").replace("0", "1e999", 1)
    if random.random() < 0.03:
        text = "[" * 100_000 + text
    return text.encode()


def _changed_json(random: Generator, found: Any) -> Any:
    if isinstance(found, dict) and found and random.random() < 0.85:
        name = _one(random, list(found))
        if random.random() < 0.12:
            return {key: value for key, value in found.items() if key != name}
        return found | {name: _changed_json(random, found[name])}
    if isinstance(found, list) and found and random.random() < 0.8:
        place = int(random.integers(len(found)))
        if random.random() < 0.2:
            return found[:place] + found[place + 1 :]
        return [*found[:place], _changed_json(random, found[place]), *found[place + 1 :]]
    others: list[Any] = [
        None,
        True,
        [],
        {},
        [[]],
        {"a": [1]},
        [1] * 1000,
        _nested(40),
        float("nan"),
        float("inf"),
    ]
    return _one(
        random, [_one(random, _NUMBERS), _one(random, _NUMBERS), _one(random, _WORDS), _one(random, others)]
    )


def _nested(depth: int) -> Any:
    found: Any = 1
    for _ in range(depth):
        found = [found]
    return found


def of_text(random: Generator, content: bytes) -> bytes:
    """A number, word or line of a TOML, CSV or XML text replaced, doubled or removed."""
    text = content.decode(errors="replace")
    lines = text.splitlines(keepends=True)
    place = int(random.integers(len(lines) or 1))
    match int(random.integers(6)):
        case 0 if lines:
            lines.insert(place, lines[place])
            return "".join(lines).encode()
        case 1 if lines:
            del lines[place]
            return "".join(lines).encode()
        case 2 | 3 | 4:
            return _with_token(random, text, r"-?\d+(?:\.\d+)?").encode(errors="surrogateescape")
        case _:
            return _with_token(random, text, r"\w+|[\[\]{}<>\"'=,;]").encode(errors="surrogateescape")


def _with_token(random: Generator, text: str, pattern: str) -> str:
    tokens = list(re.finditer(pattern, text))
    if not tokens:
        return text + str(_one(random, _WORDS))
    token = _one(random, tokens)
    new = _one(random, [*map(str, _NUMBERS), *_WORDS, "[" * 5000, "9" * 6000, '"a"', "{}", "true"])
    return text[: token.start()] + new + text[token.end() :]


def of_zip(inside: Mutation) -> Mutation:
    """An entry of a Zip file changed by another mutation, removed or emptied; its checksum is right."""

    def change(random: Generator, content: bytes) -> bytes:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = [(info.filename, archive.read(info)) for info in archive.infolist()]
        place = int(random.integers(len(entries)))
        name, found = entries[place]
        match int(random.integers(12)):
            case 0:
                del entries[place]
            case 1:
                entries[place] = (name, b"")
            case 2:
                entries[place] = (_one(random, entries)[0], found)
            case 3:
                entries[place] = (name, of_bytes(random, found))
            case _:
                entries[place] = (name, inside(random, found))
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, found in dict(entries).items():
                archive.writestr(name, found)
        return packed.getvalue()

    return change


def of_json_or_bytes(random: Generator, content: bytes) -> bytes:
    """As `of_json` for JSON, else as `of_bytes`."""
    return (of_json if content.lstrip()[:1] in (b"{", b"[") else of_bytes)(random, content)


def of_array(random: Generator, content: bytes) -> bytes:
    """Values, shape or type of a `.npy` array changed; a text in it is changed as JSON."""
    try:
        array = np.load(io.BytesIO(content), allow_pickle=False)
    except ValueError:
        return (
            of_text(random, content[:128]) + content[128:]
            if random.random() < 0.5
            else of_bytes(random, content)
        )
    if array.dtype.kind == "U" and array.shape == ():
        return content_of(np.array(of_json(random, str(array).encode()).decode()))
    match int(random.integers(6)):
        case 0:
            head, body = content[:128], content[128:]
            return (
                _same_length(_with_token(random, head.decode("latin1"), r"\d+|<|f|i|b").encode("latin1"))
                + body
            )
        case 1:
            return content_of(array.astype(_one(random, ["f2", "f4", "i1", "u8", "?", "U3", ">f8", "c16"])))
        case 2:
            return content_of(
                _one(
                    random,
                    [array[..., None], array.reshape(-1), array[:0], array[:1], array.T]
                    if array.ndim
                    else [array[None], np.zeros(0)],
                )
            )
        case _:
            return content_of(_with_value(random, array))


def _same_length(head: bytes) -> bytes:
    """A `.npy` head of 128 bytes, whatever its text has become."""
    return head.rstrip(b" \n").ljust(127)[:127] + b"\n"


def _with_value(random: Generator, array: np.ndarray) -> np.ndarray:
    if not array.size or array.dtype.kind not in "fiub":
        return np.zeros(3)
    changed = array.copy()
    where = random.random(array.shape) < _one(random, [0.01, 0.2, 1.0]) if array.ndim else ()
    if array.ndim and not where.any():
        where.flat[int(random.integers(array.size))] = True
    with np.errstate(all="ignore"):
        values: list[Any] = [0, 1, -1]
        values += [np.nan, np.inf, 1e300, -1e9, 1e-300, 3.7] if array.dtype.kind == "f" else [127, 2**31 - 1]
        changed[where] = np.array(_one(random, values)).astype(array.dtype)
    return random.permutation(array) if array.ndim and random.random() < 0.2 else changed


def of_parquet(random: Generator, content: bytes) -> bytes:
    """Columns, rows, types, values or units of a table changed."""
    table = pq.read_table(io.BytesIO(content))
    names, place = table.column_names, int(random.integers(table.num_columns))
    field, column = table.schema.field(place), table.column(place)
    match int(random.integers(9)):
        case 0:
            table = table.drop_columns([names[place]])
        case 1:
            table = table.rename_columns([*names[:place], str(_one(random, _WORDS)), *names[place + 1 :]])
        case 2:
            table = table.take(
                pa.array(random.integers(0, len(table) or 1, int(random.integers(0, 2 * len(table) + 1))))
            )
        case 3:
            unit = field.with_metadata({"unit": str(_one(random, ["µm", "px", "s", "", "x", "1"]))})
            table = table.cast(table.schema.set(place, unit))
        case 4:
            other = pa.array([str(value) for value in column.to_pylist()])
            table = table.set_column(place, field.name, other)
        case 5:
            odd = _one(random, [[None], [[1.0]], [{"a": 1}], [b"\xff"], [True], [2**62], [1e308]])
            table = table.set_column(place, field.name, pa.array(odd * len(table)))
        case _:
            table = table.set_column(place, field.name, _odd_column(random, column))
    written = io.BytesIO()
    pq.write_table(table, written)
    return written.getvalue()


def _odd_column(random: Generator, column: Any) -> Any:
    values = column.to_pylist()
    odd: list[Any] = [None]
    if pa.types.is_floating(column.type):
        odd += [float("nan"), float("inf"), -1e308, 0.0, 1e308]
    elif pa.types.is_integer(column.type):
        odd += [-1, 2**40, 2**62, 0, 7]
    elif pa.types.is_string(column.type):
        odd += ["", "x", "ok", "=1", "µ" * 2000]
    share, value = _one(random, [0.05, 0.5, 1.0]), _one(random, odd)
    return pa.array([value if random.random() < share else one for one in values], column.type)


def of_tiff(random: Generator, content: bytes) -> bytes:
    """A value, count or type of a tag of a TIFF changed, or a number in its texts."""
    if random.random() < 0.3:
        texts = list(re.finditer(rb"<\?xml.*?</OME>|\{\"shape\".*?\}|ImageJ=[^\x00]*", content, re.DOTALL))
        if texts:
            text = _one(random, texts)
            changed = of_text(random, text[0]).ljust(len(text[0]))[: len(text[0])]
            return content[: text.start()] + changed + content[text.end() :]
    order = "<" if content[:2] == b"II" else ">"
    big = struct.unpack(order + "H", content[2:4])[0] == 43
    size, offset_form, count_form = (20, "Q", "Q") if big else (12, "I", "H")
    width = 8 if big else 4
    changed = bytearray(content)
    directory = struct.unpack(order + offset_form, content[width : 2 * width])[0]
    tags: list[int] = []
    for _ in range(64):
        head = struct.calcsize(order + count_form)
        if not directory or directory + head > len(content):
            break
        number = struct.unpack_from(order + count_form, content, directory)[0]
        end = directory + head + number * size
        tags += range(directory + head, end, size)
        if end + width > len(content):
            break
        directory = struct.unpack_from(order + offset_form, content, end)[0]
    for _ in range(int(random.integers(1, 3))):
        tag = _one(random, tags)
        field, form = _one(
            random, [(0, "H"), (2, "H"), (4, offset_form), (4 + width, offset_form), (4 + width, "H")]
        )
        most = 2 ** (8 * struct.calcsize(form)) - 1
        value = _one(
            random, [0, 1, 2, 3, 8, 255, 32773, 65535, 2**31 - 1, 2**31, most, most // 3, len(content)]
        )
        struct.pack_into(order + form, changed, tag + field, min(value, most))
    return bytes(changed)


def of_fields(random: Generator, content: bytes) -> bytes:
    """Whole numbers of 2, 4 or 8 bytes overwritten at even places, most of them where heads are."""
    changed = bytearray(content)
    for _ in range(int(random.integers(1, 4))):
        form = str(_one(random, ["<H", ">H", "<I", ">I", "<i", "<q", "<Q", "<f", "<d"]))
        size = struct.calcsize(form)
        reach = len(content) if random.random() < 0.5 else min(len(content), 2048)
        place = int(random.integers(max(1, (reach - size) // 2))) * 2
        if place + size > len(content):
            continue
        if form[1] in "fd":
            value = _one(random, [float("nan"), float("inf"), 0.0, -1.0, 1e30])
        else:
            lowest, most = (-(2 ** (8 * size - 1)), 2 ** (8 * size - 1) - 1)
            if form[1].isupper():
                lowest, most = 0, 2 ** (8 * size) - 1
            value = _one(
                random, [0, 1, 2, 3, 8, 255, 65535, 2**31 - 1, 2**31, most, lowest, -1, len(content)]
            )
            value = min(max(value, lowest), most)
        struct.pack_into(form, changed, place, value)
    return bytes(changed)


def of_inner_xml(random: Generator, content: bytes) -> bytes:
    """The XML in a file of a microscope changed as text, of the same length; its coding is kept."""
    for coding in ("utf-8", "utf-16-le"):
        first, last = "<ImageDocument>".encode(coding), "</ImageDocument>".encode(coding)
        if coding == "utf-16-le":
            first, last = "<LMSData".encode(coding), "</LMSDataContainerHeader>".encode(coding)
        start, end = content.find(first), content.find(last)
        if 0 <= start < end:
            end += len(last)
            text = content[start:end].decode(coding)
            changed = of_text(random, text.encode()).decode(errors="replace").ljust(len(text))[: len(text)]
            packed = changed.encode(coding, errors="replace").ljust(end - start)[: end - start]
            return content[:start] + packed + content[end:]
    return of_bytes(random, content)


def of_png(random: Generator, content: bytes) -> bytes:
    """Bytes of a chunk of a PNG changed; its checksum is right."""
    chunks, place = [], 8
    while place + 12 <= len(content):
        length = int.from_bytes(content[place : place + 4])
        chunks.append((content[place + 4 : place + 8], content[place + 8 : place + 8 + length]))
        place += 12 + length
    number = int(random.integers(len(chunks))) if random.random() < 0.5 else 0
    name, found = chunks[number]
    chunks[number] = (
        name,
        of_bytes(random, found)[: len(found) if number == 0 else None].ljust(len(found), b"\0"),
    )
    packed = (
        len(found).to_bytes(4) + name + found + zlib.crc32(name + found).to_bytes(4) for name, found in chunks
    )
    return content[:8] + b"".join(packed)


def of_table_text(random: Generator, content: bytes) -> bytes:
    """A cell of a CSV changed, or as `of_text`."""
    if random.random() < 0.5:
        return of_text(random, content)
    table = pd.read_csv(io.BytesIO(content), dtype=str, keep_default_na=False)
    row, column = int(random.integers(len(table))), int(random.integers(len(table.columns)))
    table.iloc[row, column] = str(_one(random, [*_NUMBERS, *_WORDS]))
    return table.to_csv(index=False, sep=_one(random, [",", ";", "\t"])).encode()


def _one(random: Generator, among: Any) -> Any:
    return among[int(random.integers(len(among)))]
