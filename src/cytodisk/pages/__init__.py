"""Whole figures written to files, and the report: functions return the paths of what they wrote.

Studies: write_cell_figures and write_overview of masks, write_movie_figures, write_correlation_figures,
write_prediction_figures, write_shape_figures; write_animation, a cell beside its disk through time;
write_report, one HTML page.

Populations: write_population_figures, write_power_figure.

Comparisons of windows: write_comparison, write_compared_cells, write_compared_movie.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
