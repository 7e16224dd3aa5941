"""The status that tables give a cell, a frame and a method without results."""

import pytest

from cytodisk.errors import CytodiskError, EmptyMaskError, MapError, MaskError, ReadError, SignalError
from cytodisk.motion.following import frame_status
from cytodisk.runs.compare_windows.compare_tables import method_status
from cytodisk.runs.frame_rows import cell_status


@pytest.mark.parametrize(
    ("fault", "cell", "frame", "method"),
    [
        (ReadError, "unreadable", "unreadable", "unreadable"),
        (EmptyMaskError, "no cell", "refused", "refused"),
        (MaskError, "refused", "refused", "refused"),
        (SignalError, "no image", "refused", "no map"),
        (MapError, "refused", "refused", "no map"),
    ],
)
def test_each_table_has_its_words_for_a_fault(
    fault: type[CytodiskError], cell: str, frame: str, method: str
) -> None:
    assert (cell_status(fault("why")), frame_status(fault("why")), method_status(fault("why"))) == (
        cell,
        frame,
        method,
    )
