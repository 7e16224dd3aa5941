"""`load_map`: a map from its file."""

from __future__ import annotations

import os

from cytodisk.disk.disk_map import FACTS, DiskMap
from cytodisk.disk.map_file import read_map_file
from cytodisk.geometry.mask import MaskReport
from cytodisk.scale import Scale


def load_map(path: str | os.PathLike[str]) -> DiskMap:
    """Read a map that `DiskMap.save` wrote.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    DiskMap
        Its certificate is computed anew from the arrays that were read.

    Raises
    ------
    ReadError
        The file is missing, damaged, or not a map.

    See Also
    --------
    DiskMap.save : Writes the file.
    open_study : The maps of a whole run.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cd.map_to_disk(cd.simulate.disk(10)).save("cell.npz")
    >>> disk = cd.load_map("cell.npz")
    >>> disk.certificate.valid
    True
    """
    header, mask, arrays, nucleus, holes = read_map_file(path)
    return DiskMap(
        placed_mask=mask,
        report=MaskReport(**header["report"]),
        **arrays,
        **{name: header[name] for name in FACTS},
        scale=Scale(header.get("pixel_size_um"), header.get("frame_interval_s")),
        nucleus=nucleus,
        holes=holes,
    )
