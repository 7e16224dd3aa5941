"""The chain of pages of a TIFF: each says where the next one is."""

from __future__ import annotations

import mmap
import struct
from pathlib import Path

from cytodisk.errors import ReadError


def check_chain(file: Path) -> None:
    """Raise if the pages of a TIFF go in a circle, which would have no end.

    Parameters
    ----------
    file : Path
        Whatever else is wrong with it is left to its reader.

    Raises
    ------
    ReadError
        A page comes a second time.
    """
    with file.open("rb") as opened, mmap.mmap(opened.fileno(), 0, access=mmap.ACCESS_READ) as content:
        order = {b"II": "<", b"MM": ">"}.get(content[:2])
        if order is None or len(content) < 16:
            return
        (version,) = struct.unpack_from(f"{order}H", content, 2)
        large = version == 43
        tags, pointer = (struct.Struct(order + code) for code in ("QQ" if large else "HI"))
        tag_size, place = (20, 8) if large else (12, 4)
        seen: set[int] = set()
        while True:
            if place + pointer.size > len(content):
                return
            (page,) = pointer.unpack_from(content, place)
            if page == 0 or page + tags.size > len(content):
                return
            if page in seen:
                raise ReadError(f"{file}: its pages go in a circle: it is damaged; copy it again, whole")
            seen.add(page)
            place = page + tags.size + tag_size * tags.unpack_from(content, page)[0]
