# ruff: noqa: I001 - groups, not the alphabet

# Figures of a study
from .cell_pages import write_cell_figures as write_cell_figures
from .movie_pages import write_movie_figures as write_movie_figures
from .correlation_files import write_correlation_figures as write_correlation_figures
from .prediction.prediction_files import write_prediction_figures as write_prediction_figures
from .waves.wave_files import write_wave_figures as write_wave_figures
from .shape_pages import write_shape_figures as write_shape_figures
from .overview import write_overview as write_overview
from .animation import write_animation as write_animation
from .report.page import write_report as write_report

# Figures of a comparison
from .compared_layers import write_comparison as write_comparison
from .compared_cells import write_compared_cells as write_compared_cells
from .compared_movie import write_compared_movie as write_compared_movie

# Figures of a population
from .population.write_population_figures import write_population_figures as write_population_figures
from .population.pooled_page import write_pooled_figure as write_pooled_figure
from .population.pooled_gain_page import write_pooled_gains as write_pooled_gains
from .population.pooled_wave_page import write_pooled_waves as write_pooled_waves
from .population.power_page import write_power_figure as write_power_figure
