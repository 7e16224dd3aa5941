"""Arrays and pictures as text that a page can carry."""

from __future__ import annotations

import base64
import io
import json
import zlib
from typing import Any

import numpy as np
from PIL import Image

_JPEG_QUALITY = 85  # of pictures that are only looked at; no number is read off them


def pack_floats(values: Any) -> dict[str, Any]:
    """An array for the page's `unpack`.

    Parameters
    ----------
    values : array_like of float
        NaN stays NaN.

    Returns
    -------
    dict
        "shape", and "data": the numbers as little-endian float32 in row-major order, zlib, base64.
    """
    array = np.asarray(values, dtype="<f4")
    return {"shape": list(array.shape), "data": pack_bytes(array.tobytes())}


def pack_labels(labels: Any) -> str:
    """Numbers of windows as little-endian uint16 in row-major order, zlib, base64; see `pack_floats`."""
    return pack_bytes(np.asarray(labels, dtype="<u2").tobytes())


def pack_bytes(data: bytes) -> str:
    """Compress with zlib and write as base64."""
    return base64.b64encode(zlib.compress(data, 8)).decode("ascii")


def grey_levels(image: Any, low: float, high: float) -> Any:
    """Grey levels from black at `low` to white at `high`.

    Parameters
    ----------
    image : array_like of shape (H, W)
        NaN becomes black.
    low, high : float
        The second above the first.

    Returns
    -------
    ndarray of shape (H, W) and dtype uint8
    """
    share = np.nan_to_num((np.asarray(image, dtype=np.float64) - low) / (high - low))
    return np.rint(255 * np.clip(share, 0.0, 1.0)).astype(np.uint8)


def pack_picture(grey: Any) -> str:
    """A grey picture, shape (H, W) and dtype uint8, as JPEG in base64."""
    with io.BytesIO() as file:
        Image.fromarray(grey).save(file, "JPEG", quality=_JPEG_QUALITY)
        return base64.b64encode(file.getvalue()).decode("ascii")


def json_for_script(value: Any) -> str:
    """JSON that can stand inside a `<script>` element whatever the words in it.

    Parameters
    ----------
    value : JSON-able
        NaN and infinite numbers become null.

    Returns
    -------
    str
        Without "<", so that nothing in it can end the element or open a comment.
    """
    text = json.dumps(_finite(value), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if isinstance(value, np.generic):
        return _finite(value.item())
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
