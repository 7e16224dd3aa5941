"""How two arrays, or two pictures, differ: in words."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageSequence

# Words in texts of tables, as they were and as they are.
REWORDED: dict[str, str] = {}


def difference(old: np.ndarray, new: np.ndarray) -> str:
    """How two arrays differ, in words; empty if they are equal bit for bit."""
    if old.shape != new.shape:
        return f"shape {old.shape} → {new.shape}"
    if not (_is_number(old) and _is_number(new)):
        return _difference_of_texts(old.ravel().tolist(), new.ravel().tolist())
    if old.dtype != new.dtype:
        return f"type {old.dtype} → {new.dtype}"
    if old.tobytes() == new.tobytes():
        return ""
    return _difference_of_numbers(old.astype(float).ravel(), new.astype(float).ravel())


def _difference_of_numbers(old: np.ndarray, new: np.ndarray) -> str:
    lone = np.isnan(old) != np.isnan(new)
    apart = np.nan_to_num(np.abs(old - new)[~lone], nan=0.0)
    size = np.nan_to_num(np.maximum(np.abs(old), np.abs(new))[~lone], nan=0.0)
    relative = np.divide(apart, size, out=np.zeros_like(apart), where=size > 0)
    count = int((apart > 0).sum())
    if not count and not lone.any():
        return ""  # 0 and -0, or NaN of another kind
    words = f"{count} of {len(old)} differ, by at most {apart.max(initial=0.0):.3g}"
    words += f" (relative {relative.max(initial=0.0):.3g})"
    return words + (f"; NaN on one side only: {int(lone.sum())}" if lone.any() else "")


def _difference_of_texts(old: Sequence[Any], new: Sequence[Any]) -> str:
    pairs = [(_reworded(a), _text(b)) for a, b in zip(old, new, strict=True)]
    apart = [(a, b) for a, b in pairs if a != b]
    return f"{len(apart)} of {len(pairs)} differ, as {apart[0][0]!r} → {apart[0][1]!r}" if apart else ""


def compare_pictures(old: Path, new: Path) -> str:
    """How many pixels of two pictures differ, in words; empty if none."""
    with Image.open(old) as first, Image.open(new) as second:
        if first.size != second.size:
            return f"size {first.size} → {second.size}"
        frames = [
            [np.asarray(frame.convert("RGBA")) for frame in ImageSequence.Iterator(picture)]
            for picture in (first, second)
        ]
    if len(frames[0]) != len(frames[1]):
        return f"{len(frames[0])} → {len(frames[1])} frames"
    apart = np.mean([(a != b).any(axis=2).mean() for a, b in zip(*frames, strict=True)])
    return f"{apart:.2%} of pixels differ" if apart else ""


def _is_number(values: np.ndarray) -> bool:
    return values.dtype.kind in "biuf"


def _text(value: Any) -> str:
    return "" if value is None or value != value else str(value)


def _reworded(value: Any) -> str:
    text = _text(value)
    for old, new in REWORDED.items():
        text = text.replace(old, new)
    return text
