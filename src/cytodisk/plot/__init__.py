"""Matplotlib pictures of cells, their disks and their windows; functions take Axes and return artists.

Units and times come from what is drawn: arrays, maps and movies carry them. For plain numbers pass a `Scale`.

A mask and its disk: draw_cell, draw_outline, draw_nucleus, draw_mesh; draw_area_distortion and
draw_area_spread; draw_disk_image, draw_disk_mesh.

Windows: draw_windows, draw_window_means, draw_window_labels, draw_sectors, draw_strip on the cell;
draw_disk_windows, draw_disk_means on the disk; frame_cell fits axes to a cell.

From the nucleus to the membrane: draw_nucleus_profile, a signal by layer with both borders.

Movies: draw_activity_map, draw_velocity_map, draw_layers by frame and sector; draw_line_kymograph and
draw_boundary_kymograph; draw_velocity_arrows, draw_tracks, draw_area_change and draw_mean_velocity of the
edge; draw_by_layer for lines of layers.

Correlations: draw_correlation_curves with curve_key, draw_map_pair, draw_pairs; PeakMap for
draw_peaks_on_cell and draw_peaks_on_disk with peak_key; draw_events, draw_event_average with band_key.

Predictions: draw_network with draw_link_layers and network_key; draw_gain_profile with gain_key;
draw_lag_coefficients.

Waves: draw_wave_kymograph with crests, draw_wave_phase, draw_phase_on_cell and draw_phase_on_disk with
phase_key; draw_mode_power and draw_wave_spectrum by number around the cell; draw_depth_speeds.

Shapes: draw_shape_landscape, the plane of the complexity score; draw_shape_examples, cells by their outlines.

Populations: draw_atlas by condition, on the disk or on a cell; DifferenceMap for draw_difference with
difference_key; draw_condition_profiles, draw_pooled_curves and draw_mean_curves with condition_key;
draw_super_plot with experiment_key, draw_dose_trend with dose_trend_key; draw_effect_sizes,
draw_directions, draw_gallery, draw_window_gallery, draw_power.

Looks: paper_style for the sizes of a printed page, colour_bar, scale_bar.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
