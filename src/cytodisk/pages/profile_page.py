"""The page of a movie's signal from the nucleus to the membrane."""

from cytodisk.pages.drawn_movie import DrawnMovie
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.nucleus.nucleus_profile import CHANNEL_COLOURS, draw_nucleus_profile
from cytodisk.plot.style import WIDE_MM

_LEFT, _GAP, _RIGHT, _PANEL = 13.0, 16.0, 7.0, 48.0  # mm


def profile_sheet(movie: DrawnMovie) -> Sheet:
    """Channels over their mean of the cell, by layer, and by the distance to the nuclear outline.

    Parameters
    ----------
    movie : DrawnMovie
        Of a cell with a nucleus and a signal; of more than four channels the first four are drawn.

    Returns
    -------
    Sheet
    """
    top = movie.heading_mm + 6.0
    sheet = Sheet(top + _PANEL + 13.0)
    channels = range(min(len(movie.channels), len(CHANNEL_COLOURS)))
    names = [movie.shown_name(channel) for channel in channels]
    data = movie.activity.isel(channel=list(channels)).assign_coords(channel=names)
    data = data.dropna("time", how="all", subset=["area"])
    movie.write_heading(sheet, "signal from the nucleus to the membrane, mean of frames")
    width = (WIDE_MM - _LEFT - _GAP - _RIGHT) / 2
    by_layer = sheet.axes(_LEFT, top, width, _PANEL)
    draw_nucleus_profile(by_layer, data, relative=True)
    by_layer.legend(frameon=False, loc="best", handlelength=1.4)
    draw_nucleus_profile(
        sheet.axes(_LEFT + width + _GAP, top, width, _PANEL), data, along="distance", relative=True
    )
    sheet.text(_LEFT, movie.heading_mm + 1.5, "bands: quartiles of sectors", color="0.3")
    return sheet
