import base64
import io
import json
import zlib

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from cytodisk.pages.report.encode import grey_levels, json_for_script, pack_floats, pack_labels, pack_picture


def test_floats_come_back() -> None:
    values = np.array([[1.5, np.nan], [-3.0, 1e9]])
    packed = pack_floats(values)
    assert packed["shape"] == [2, 2]
    found = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), "<f4").reshape(2, 2)
    np.testing.assert_array_equal(found, values.astype(np.float32))


def test_labels_come_back() -> None:
    labels = np.array([[0, 65535], [300, 7]], dtype=np.uint16)
    found = np.frombuffer(zlib.decompress(base64.b64decode(pack_labels(labels))), "<u2")
    assert found.tolist() == [0, 65535, 300, 7]


def test_picture_runs_from_black_to_white() -> None:
    image = np.repeat(np.array([[-5.0, 10.0, 20.0, 30.0, 99.0, np.nan]]), 16, axis=1).repeat(16, axis=0)
    with Image.open(io.BytesIO(base64.b64decode(pack_picture(grey_levels(image, 10.0, 30.0))))) as picture:
        grey = np.asarray(picture)
    assert grey.shape == image.shape
    np.testing.assert_allclose(grey[8, 8::16], [0, 0, 128, 255, 255, 0], atol=3)


@given(st.text())
def test_no_word_ends_the_script(word: str) -> None:
    text = json_for_script({"word": word, "key</script>": "<!-- </SCRIPT >"})
    assert "<" not in text
    assert json.loads(text) == {"word": word, "key</script>": "<!-- </SCRIPT >"}


def test_numbers_of_any_kind() -> None:
    value = {"a": np.float64("nan"), "b": [np.int64(3), float("inf")], 4: (np.float32(0.5), None)}
    assert json.loads(json_for_script(value)) == {"a": None, "b": [3, None], "4": [0.5, None]}
