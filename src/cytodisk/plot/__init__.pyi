# ruff: noqa: I001 - groups, not the alphabet

# A mask and its disk
from .cell.cell_axes import draw_cell as draw_cell
from .cell.cell_axes import draw_outline as draw_outline
from .cell.cell_axes import draw_nucleus as draw_nucleus
from .cell.cell_axes import draw_mesh as draw_mesh
from .cell.area_distortion import draw_area_distortion as draw_area_distortion
from .cell.area_distortion import draw_area_spread as draw_area_spread
from .cell.disk_axes import draw_disk_image as draw_disk_image
from .cell.disk_axes import draw_disk_mesh as draw_disk_mesh
from .cell.cell_axes import frame_cell as frame_cell

# Windows
from .cell.window_polygons import draw_windows as draw_windows
from .cell.window_polygons import draw_window_means as draw_window_means
from .cell.window_labels import draw_window_labels as draw_window_labels
from .cell.sector_marks import draw_sectors as draw_sectors
from .cell.frame_strip import draw_strip as draw_strip
from .cell.disk_axes import draw_disk_windows as draw_disk_windows
from .cell.disk_axes import draw_disk_means as draw_disk_means

# From the nucleus to the membrane
from .nucleus.nucleus_profile import draw_nucleus_profile as draw_nucleus_profile

# Movies
from .movie.activity_maps import draw_activity_map as draw_activity_map
from .movie.activity_maps import draw_velocity_map as draw_velocity_map
from .movie.activity_maps import draw_layers as draw_layers
from .movie.layer_lines import draw_by_layer as draw_by_layer
from .movie.mean_velocity import draw_mean_velocity as draw_mean_velocity
from .movie.edge_arrows import draw_velocity_arrows as draw_velocity_arrows
from .movie.edge_motion import draw_tracks as draw_tracks
from .movie.edge_motion import draw_area_change as draw_area_change
from .movie.kymograph_lines import draw_line_kymograph as draw_line_kymograph
from .movie.kymograph_lines import draw_boundary_kymograph as draw_boundary_kymograph

# Correlations and events
from .correlation.correlation_curves import draw_correlation_curves as draw_correlation_curves
from .correlation.curve_key import curve_key as curve_key
from .correlation.correlation_curves import draw_map_pair as draw_map_pair
from .correlation.pair_curves import draw_pairs as draw_pairs
from .correlation.correlation_peaks import PeakMap as PeakMap
from .correlation.peak_maps import draw_peaks_on_cell as draw_peaks_on_cell
from .correlation.peak_maps import draw_peaks_on_disk as draw_peaks_on_disk
from .correlation.peak_maps import peak_key as peak_key
from .correlation.event_curves import draw_events as draw_events
from .correlation.event_curves import draw_event_average as draw_event_average
from .correlation.event_curves import band_key as band_key

# Predictions
from .prediction.network_picture import draw_network as draw_network
from .prediction.network_picture import network_key as network_key
from .prediction.link_layers import draw_link_layers as draw_link_layers
from .prediction.gain_profile import draw_gain_profile as draw_gain_profile
from .prediction.gain_profile import gain_key as gain_key
from .prediction.lag_coefficients import draw_lag_coefficients as draw_lag_coefficients

# Waves
from .waves.wave_kymograph import draw_wave_kymograph as draw_wave_kymograph
from .waves.wave_kymograph import draw_wave_phase as draw_wave_phase
from .waves.phase_colours import phase_key as phase_key
from .waves.phase_places import draw_phase_on_cell as draw_phase_on_cell
from .waves.phase_places import draw_phase_on_disk as draw_phase_on_disk
from .waves.mode_power import draw_mode_power as draw_mode_power
from .waves.wave_spectrum import draw_wave_spectrum as draw_wave_spectrum
from .waves.depth_speeds import draw_depth_speeds as draw_depth_speeds

# Shapes
from .shape.shape_plane import draw_shape_landscape as draw_shape_landscape
from .shape.shape_rows import draw_shape_examples as draw_shape_examples

# Populations
from .population.population_maps import draw_atlas as draw_atlas
from .population.population_maps import draw_difference as draw_difference
from .population.difference_map import DifferenceMap as DifferenceMap
from .population.population_maps import difference_key as difference_key
from .population.condition_profiles import draw_condition_profiles as draw_condition_profiles
from .population.condition_profiles import condition_key as condition_key
from .population.super_plot import draw_super_plot as draw_super_plot
from .population.dose_trends import draw_dose_trend as draw_dose_trend
from .population.dose_trend_key import dose_trend_key as dose_trend_key
from .population.experiment_key import experiment_key as experiment_key
from .population.effect_sizes import draw_effect_sizes as draw_effect_sizes
from .population.cell_gallery import draw_gallery as draw_gallery
from .population.cell_gallery import draw_window_gallery as draw_window_gallery
from .population.directions import draw_directions as draw_directions
from .population.pooled_curve_lines import draw_pooled_curves as draw_pooled_curves
from .population.mean_curves import draw_mean_curves as draw_mean_curves
from .population.power_curves import draw_power as draw_power

# Looks
from .style import paper_style as paper_style
from .style import colour_bar as colour_bar
from .style import scale_bar as scale_bar
