"""An image whose frames are made when they are looked at."""

import copy

import numpy as np
import pytest

from cytodisk.napari.study_layers.frame_stack import FrameStack

WHOLE = np.arange(60).reshape(5, 3, 4)
KEYS = [
    2,
    -1,
    np.int64(3),
    (1, slice(None), slice(None)),
    (1, 2, 3),
    (slice(1, 4), 2),
    slice(None, None, 2),
    (slice(2, 2), slice(None), 1),
    (..., 0),
    (np.array([4, 0]), slice(None), slice(1, 3)),
]


@pytest.mark.parametrize("key", KEYS, ids=str)
def test_it_is_indexed_as_an_array(key: object) -> None:
    stack = FrameStack(lambda t: WHOLE[t], WHOLE.shape, WHOLE.dtype)

    assert np.array_equal(stack[key], WHOLE[key])


def test_only_the_frames_that_are_asked_for_are_made() -> None:
    made: list[int] = []

    def frame(t: int) -> np.ndarray:
        made.append(t)
        return WHOLE[t]

    stack = FrameStack(frame, WHOLE.shape, WHOLE.dtype)

    assert (stack.ndim, stack.size, len(stack)) == (3, 60, 5)
    assert not made
    assert stack[3, 1:, 2].tolist() == WHOLE[3, 1:, 2].tolist()
    assert made == [3]
    assert np.array_equal(copy.deepcopy(stack), WHOLE)


def test_a_frame_that_is_not_there_is_refused() -> None:
    with pytest.raises(IndexError):
        FrameStack(lambda t: WHOLE[t], WHOLE.shape, WHOLE.dtype)[5]
