"""Errors go from process to process as they are."""

import inspect
import pickle

import pytest

from cytodisk import errors

LEAVES = [
    found for _, found in inspect.getmembers(errors, inspect.isclass) if found.__module__ == errors.__name__
]


@pytest.mark.parametrize("error", LEAVES, ids=lambda error: error.__name__)
def test_an_error_can_be_made_again_from_what_it_says(error: type[Exception]) -> None:
    remade = pickle.loads(pickle.dumps(error("words")))
    assert (type(remade), str(remade)) == (error, "words")
    assert str(error.__new__(error, "words")) == "words"  # how tblib does it, once Dask is loaded


def test_an_error_that_is_kept_leaves_behind_what_led_to_it() -> None:
    try:
        try:
            raise DecoderError("zlib", -3)
        except DecoderError as cause:
            raise errors.ReadError("a.tif cannot be read") from cause
    except errors.ReadError as error:
        fault = errors.as_data(error)
    assert (fault.__cause__, fault.__context__, fault.__traceback__) == (None, None, None)


class DecoderError(Exception):
    """As that of imagecodecs, which cannot be unpickled."""

    def __init__(self, codec: str, code: int) -> None:
        super().__init__(f"{codec} {code}")
