"""The public names, by what a user does; the reference shows these groups."""

# ruff: noqa: I001 - groups, not the alphabet

from . import errors as errors
from . import pages as pages
from . import plot as plot
from . import simulate as simulate

__version__: str

# Files and their scale
from .images.frames import read_image as read_image
from .scale import Scale as Scale

# One cell: mask, map, proof
from .geometry.mask import clean_mask as clean_mask
from .geometry.mask import MaskReport as MaskReport
from .geometry.nucleus_mask import fit_nucleus as fit_nucleus
from .geometry.nucleus_report import NucleusReport as NucleusReport
from .images.nuclei.match_nuclei import match_nuclei as match_nuclei
from .disk.mapping import map_to_disk as map_to_disk
from .disk.disk_map import DiskMap as DiskMap
from .disk.nucleus.nucleus import Nucleus as Nucleus
from .disk.loading import load_map as load_map
from .disk.certificate import certify as certify
from .disk.certificate import Certificate as Certificate
from .disk.distortion import Distortion as Distortion

# Windows, and the signal in them
from .windows.polar_windows import polar_windows as polar_windows
from .windows.polar_windows import PolarGrid as PolarGrid
from .windows.polar_windows import CellWindows as CellWindows
from .windows.sample import sample as sample
from .windows.edge_windows import edge_windows as edge_windows
from .windows.edge_windows import EdgeGrid as EdgeGrid
from .windows.edge_windows import EdgeWindows as EdgeWindows
from .windows.springs.spring_windows import spring_windows as spring_windows
from .windows.springs.spring_windows import SpringGrid as SpringGrid
from .windows.springs.spring_windows import SpringWindows as SpringWindows
from .windows.ring_windows import ring_windows as ring_windows
from .windows.ring_windows import RingGrid as RingGrid
from .windows.ring_windows import RingWindows as RingWindows
from .windows.rings.nucleus_rings import nucleus_ring_windows as nucleus_ring_windows
from .windows.rings.nucleus_ring_grid import NucleusRingGrid as NucleusRingGrid
from .windows.rings.nucleus_rings import NucleusRingWindows as NucleusRingWindows
from .windows.rings.interpolated_rings import interpolated_ring_windows as interpolated_ring_windows
from .windows.rings.nucleus_ring_grid import InterpolatedRingGrid as InterpolatedRingGrid
from .windows.rings.interpolated_rings import InterpolatedRingWindows as InterpolatedRingWindows
from .windows.on_cell import WindowsOnCell as WindowsOnCell
from .analysis.window_measures import window_measures as window_measures
from .analysis.window_measures import measures_by_layer as measures_by_layer
from .analysis.compartments.nuclear_profile import nuclear_profile as nuclear_profile
from .analysis.compartments.nucleus_summary import nucleus_summary as nucleus_summary

# Movies and the edge
from .motion.map_movie import map_movie as map_movie
from .motion.disk_movie import DiskMovie as DiskMovie
from .motion.demons_parameters import DemonsParameters as DemonsParameters
from .analysis.activity import sample_movie as sample_movie
from .motion.velocity import edge_velocity as edge_velocity
from .motion.velocity import boundary_velocity as boundary_velocity
from .motion.velocity import edge_changes as edge_changes
from .analysis.consistency import consecutive_correlation as consecutive_correlation
from .analysis.consistency import centroid_displacement as centroid_displacement
from .analysis.kymograph import boundary_kymograph as boundary_kymograph
from .analysis.kymograph import line_kymograph as line_kymograph

# Correlations and events
from .analysis.correlation.cross_correlation import cross_correlate as cross_correlate
from .analysis.correlation.peaks import peak_correlation as peak_correlation
from .analysis.correlation.cross_correlation import correlation_by_layer as correlation_by_layer
from .analysis.correlation.clusters import correlation_clusters as correlation_clusters
from .analysis.pairs.pair_correlation import correlate_pairs as correlate_pairs
from .analysis.pairs.window_distances import window_distances as window_distances
from .analysis.correlation.prepared_series import prepare_series as prepare_series
from .analysis.correlation.jitter_mark import jitter_step as jitter_step
from .analysis.correlation.jitter_mark import velocity_jitter as velocity_jitter
from .analysis.stress.stress_marks import stress_marks as stress_marks
from .analysis.controls.geometry_controls import geometry_controls as geometry_controls
from .analysis.controls.without_controls import without_controls as without_controls
from .analysis.events import edge_events as edge_events
from .analysis.event_average import average_around as average_around

# Prediction: does the past of one signal predict another
from .analysis.prediction.predict import predict as predict
from .analysis.prediction.direction_support import weaker_direction as weaker_direction
from .analysis.prediction.prediction_parameters import PredictionParameters as PredictionParameters

# Waves: do they run around the cell, or inwards
from .analysis.waves.edge_waves import edge_waves as edge_waves
from .analysis.waves.disk_waves import disk_waves as disk_waves
from .analysis.waves.waves_parameters import WaveSearchParameters as WaveSearchParameters

# Shapes
from .analysis.shape.features import shape_features as shape_features
from .analysis.shape.complexity import complexity_score as complexity_score
from .analysis.shape.medoid_cell import medoid_cell as medoid_cell

# Populations: many cells by condition and experiment
from .population.population import Population as Population
from .population.conditions.condition_comparison import compare_conditions as compare_conditions
from .population.conditions.condition_comparison import ConditionComparison as ConditionComparison
from .population.conditions.with_control import compare_with_control as compare_with_control
from .population.conditions.with_zero import compare_with_zero as compare_with_zero
from .population.conditions.with_zero import ZeroComparison as ZeroComparison
from .population.conditions.pattern_test import pattern_test as pattern_test
from .population.conditions.pattern_test import PatternTest as PatternTest
from .population.conditions.dose_trend import dose_trend as dose_trend
from .population.conditions.dose_trend import DoseTrend as DoseTrend
from .population.comparison_parameters import ComparisonParameters as ComparisonParameters
from .population.comparison_parameters import DoseParameters as DoseParameters
from .population.comparison_parameters import PermutationParameters as PermutationParameters
from .population.named_warning import NamedWarning as NamedWarning
from .runs.population.opening.open_population import open_population as open_population
from .runs.population.opening.population_tables import population_from_tables as population_from_tables
from .runs.population.power.population_power import population_power as population_power
from .runs.population.power.power_parameters import PowerParameters as PowerParameters

# Runs: what the commands do
from .runs.map.run_map import run_map as run_map
from .runs.movie.run_movie import run_movie as run_movie
from .runs.shapes.run_shapes import run_shapes as run_shapes
from .runs.waves.run_waves import run_waves as run_waves
from .runs.correlate.run_correlate import run_correlate as run_correlate
from .runs.predict.run_predict import run_predict as run_predict
from .runs.population.correlations.run_batch_correlate import run_batch_correlate as run_batch_correlate
from .runs.population.predictions.run_batch_predict import run_batch_predict as run_batch_predict
from .runs.population.wave_numbers.run_batch_waves import run_batch_waves as run_batch_waves
from .runs.compare_windows.run_compare_windows import run_compare_windows as run_compare_windows
from .runs.batch.run_batch import run_batch as run_batch
from .runs.population.run_population import run_population as run_population
from .runs.export.run_export import run_export as run_export
from .runs.map.map_parameters import MapParameters as MapParameters
from .runs.movie.movie_parameters import MovieParameters as MovieParameters
from .runs.shapes.shape_parameters import ShapeParameters as ShapeParameters
from .runs.waves.wave_run_parameters import WavesParameters as WavesParameters
from .runs.correlate.correlate_parameters import CorrelateParameters as CorrelateParameters
from .runs.predict.predict_parameters import PredictParameters as PredictParameters
from .runs.population.correlations.batch_correlate_parameters import (
    BatchCorrelateParameters as BatchCorrelateParameters,
)
from .runs.population.predictions.batch_predict_parameters import (
    BatchPredictParameters as BatchPredictParameters,
)
from .runs.population.wave_numbers.batch_waves_parameters import BatchWavesParameters as BatchWavesParameters
from .runs.population.pooling.pool_parameters import PoolOptions as PoolOptions
from .runs.compare_windows.compare_parameters import CompareWindowsParameters as CompareWindowsParameters
from .runs.compare_windows.compare_parameters import CompareMovieParameters as CompareMovieParameters
from .runs.compare_windows.compare_parameters import CompareNucleiParameters as CompareNucleiParameters
from .runs.population.population_parameters import PopulationParameters as PopulationParameters
from .runs.run_options import FolderOptions as FolderOptions
from .runs.run_options import MapOptions as MapOptions
from .runs.run_options import ExportOptions as ExportOptions
from .runs.run_options import RunOptions as RunOptions
from .runs.run_options import BatchOptions as BatchOptions
from .runs.run_options import PopulationOptions as PopulationOptions

# Results of runs
from .store.spatial.place_parameters import SpatialParameters as SpatialParameters
from .store.study import open_study as open_study
from .store.study import Study as Study
from .store.populations.pooled_correlation import open_pooled_correlation as open_pooled_correlation
from .store.populations.pooled_correlation import PooledCorrelation as PooledCorrelation
from .store.populations.pooled_prediction import open_pooled_prediction as open_pooled_prediction
from .store.populations.pooled_prediction import PooledPrediction as PooledPrediction
from .store.populations.pooled_waves import open_pooled_waves as open_pooled_waves
from .store.populations.pooled_waves import PooledWaves as PooledWaves
from .runs.compare_windows.comparison import open_comparison as open_comparison
from .runs.compare_windows.comparison import Comparison as Comparison
from .runs.shapes.shape_tables import open_shapes as open_shapes
from .store.populations.population_study import open_population_study as open_population_study
from .store.populations.population_study import PopulationStudy as PopulationStudy
from .store.populations.population_study import StudyWarning as StudyWarning
from .runs.qc_flags.study_flags import qc_flags as qc_flags
from .pages.report.page import write_report as write_report
