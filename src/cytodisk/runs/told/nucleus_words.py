"""What commands say of the signals in nucleus and cytoplasm."""

from typing import TYPE_CHECKING

from cytodisk.number_words import counted, rounded
from cytodisk.store.nuclei.summary_columns import (
    PERINUCLEAR_SHARE,
    PERIPHERAL_SHARE,
    RATIO,
    channels_among,
    column_of,
)

if TYPE_CHECKING:
    import pandas as pd


def nucleus_ratio_words(cells: "pd.DataFrame", of: str = "cell") -> str:
    """The mean ratio of nucleus to cytoplasm by channel, in a line; empty without one.

    Parameters
    ----------
    cells : DataFrame
        Of a study.
    of : str
        What a row of it is.
    """
    ratios = {
        channel: cells[column_of(RATIO, channel)].dropna() for channel in channels_among(map(str, cells))
    }
    known = {channel: values for channel, values in ratios.items() if len(values)}
    if not known:
        return ""
    numbers = sorted({len(values) for values in known.values()})
    if len(numbers) == 1:
        words = ", ".join(f"{channel} {rounded(values.mean())}" for channel, values in known.items())
        return (
            f"nucleus to cytoplasm: {words} (mean of {counted(numbers[0], of)}, background as in the image)"
        )
    words = ", ".join(
        f"{channel} {rounded(values.mean())} ({counted(len(values), of)})"
        for channel, values in known.items()
    )
    return f"nucleus to cytoplasm: {words} (means, background as in the image)"


def nucleus_share_words(cells: "pd.DataFrame") -> str:
    """The mean shares of the cytoplasm's signal near nucleus and membrane, in a line; empty without one.

    Parameters
    ----------
    cells : DataFrame
        Of a study.
    """
    shares = {
        channel: cells[[column_of(name, channel) for name in (PERINUCLEAR_SHARE, PERIPHERAL_SHARE)]].dropna()
        for channel in channels_among(map(str, cells))
    }
    words = [
        f"{channel} {near:.2f} and {far:.2f}"
        for channel, values in shares.items()
        if len(values)
        for near, far in [values.mean()]
    ]
    if not words:
        return ""
    listed = ", ".join(words)
    return f"cytoplasm's signal in its third at the nucleus and at the membrane: {listed} (an even one: 0.33)"
