"""`SpatialStudy`: the part of a study that turns it into an object of other programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cytodisk.store.spatial.place_parameters import SpatialParameters
from cytodisk.store.spatial.spatialdata_object import spatialdata_of
from cytodisk.taking import takes

if TYPE_CHECKING:
    from cytodisk.store.spatial.spatialdata_object import SpatialData
    from cytodisk.store.spatial.study_places import MappedStudy


class SpatialStudy:
    """What a study gives to the programs of scverse."""

    @takes(SpatialParameters)
    def to_spatialdata(self: MappedStudy, **settings: Any) -> SpatialData:
        """Cells and windows as a SpatialData object, for squidpy, napari-spatialdata and others of scverse.

        Parameters
        ----------
        **settings
            See `SpatialParameters`.

        Returns
        -------
        spatialdata.SpatialData
            Images "image", with the channels; labels "cell_labels" and "window_labels"; shapes "cells",
            "windows" and "nuclei"; tables "cell_table" and "window_table". Of a study with several images, or
            frames, each has its own, as "windows_frame_012"; a table has the rows of all. Coordinates are
            (x, y) in pixels from the image's corner, where pixel (0, 0) covers 0 to 1, in the coordinate
            system "global"; "µm" is there if the scale is known. Each image of several has coordinate systems
            of its own, as "frame_012" and "frame_012_µm".

        Raises
        ------
        MissingPartError
            spatialdata is not installed.
        ReadError
            A map or an image is not there any more; the message names it. Or it is too much for the memory.

        Notes
        -----
        In a table `X` has the mean of each channel, `obs` the cell, frame, layer, sector, depth, condition
        and experiment, `obsm["spatial"]` the centre in pixels. `obs["region"]` names the shapes and
        `obs["instance_id"]` the number of the shape in its index, which is its value in the labels, too.
        Cells without a map are in `attrs["cytodisk"]["left_out"]`, with the reason.

        Examples
        --------
        >>> import tifffile
        >>> import cytodisk as cd
        >>> tifffile.imwrite("mask.tif", cd.simulate.disk(12).astype("uint8"))
        >>> study = cd.run_map("mask.tif", "out", layers=3, sectors=8)
        >>> data = study.to_spatialdata()  # doctest: +SKIP
        >>> data["windows"].shape, data["window_table"].obs["layer"].max()  # doctest: +SKIP
        ((24, 4), 2)
        >>> data.write("out.zarr")  # doctest: +SKIP
        """
        return spatialdata_of(self, SpatialParameters.of(**settings))
