"""The widget "Follow cells"."""

from __future__ import annotations

from typing import Any

from cytodisk.napari.commands.layers_widget import LayersWidget
from cytodisk.napari.commands.study_runs import run_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.run_options import RunOptions

_WITHOUT = ("tracks", "resume", "overwrite")  # tracks are a layer; the folder is new


class FollowCells(LayersWidget):
    """Follow the cells of open layers through a movie, as `cytodisk movie` does.

    Parameters
    ----------
    napari_viewer : Viewer
    """

    command = "movie"

    def __init__(self, napari_viewer: Any):
        models = (MovieParameters, RunOptions)
        super().__init__(napari_viewer, models, "Follow cells", _WITHOUT, run_movie)
