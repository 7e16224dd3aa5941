"""Areas of windows out of a study, without the rest of its largest table."""

from collections.abc import Collection

import pyarrow.parquet as pq

from cytodisk.arrays import FloatArray
from cytodisk.store.study import WINDOWS, Study


def areas_px(study: Study, places: Collection[tuple[int, int]]) -> list[FloatArray]:
    """Areas of the windows of some cells in some frames.

    Parameters
    ----------
    study : Study
    places : collection of (int, int)
        (cell, frame).

    Returns
    -------
    list of ndarray of shape (layers, sectors) and dtype float
        In square pixels, in the order of cells and frames.
    """
    wanted = [(name, "in", sorted({place[k] for place in places})) for k, name in enumerate(_PLACE)]
    names = [*_PLACE, "layer", "sector", "area"]
    table = pq.read_table(study.path / WINDOWS, columns=names, filters=wanted).to_pandas()
    table = table.drop_duplicates(names[:-1])  # of all channels
    layers, sectors = table["layer"].max() + 1, table["sector"].max() + 1
    return [
        rows["area"].to_numpy().reshape(layers, sectors) / study.scale.area(1.0)
        for place, rows in table.groupby(list(_PLACE))
        if place in places
    ]


_PLACE = ("cell", "frame")
