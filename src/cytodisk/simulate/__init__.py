"""Cells, signals and random masks with known answers, for the demo, the docs, tests and benchmarks."""

from cytodisk.simulate.cells import disk, dumbbell, ellipse, star
from cytodisk.simulate.driven.driven_movies import DrivenMovie
from cytodisk.simulate.driven.predicting_movies import predicting_movie
from cytodisk.simulate.driven.wave_movies import wave_movie
from cytodisk.simulate.label_images import label_image
from cytodisk.simulate.mask_faults import flipped_masks, scaled_up_masks
from cytodisk.simulate.movie_kinds import EDGE_KINDS, MOVIE_KINDS
from cytodisk.simulate.moving_cells import SimulatedMovie, movie
from cytodisk.simulate.nuclei.cells_with_nuclei import (
    CELL_SHAPES,
    NUCLEUS_KINDS,
    CellWithNucleus,
    cell_with_nucleus,
)
from cytodisk.simulate.nuclei.label_images_with_nuclei import (
    NUCLEUS_CASES,
    CellsWithNuclei,
    label_image_with_nuclei,
)
from cytodisk.simulate.nuclei.movies_with_nuclei import MovieWithNuclei, movie_with_nuclei
from cytodisk.simulate.nuclei.profile_signals import between_nucleus_and_membrane, profile_signal
from cytodisk.simulate.nuclei.random_pairs import PAIR_CELLS, PAIR_NUCLEI, random_pair, random_pair_kinds
from cytodisk.simulate.null_series import SERIES_KINDS, coupled_series, independent_series
from cytodisk.simulate.passive_signals import PASSIVE_KINDS, passive_signal
from cytodisk.simulate.populations.population_images import PopulationImages, population_images
from cytodisk.simulate.populations.simulated_populations import SimulatedPopulation, population
from cytodisk.simulate.predicting.predicting_parameters import COUPLINGS
from cytodisk.simulate.predicting.predicting_series import PREDICTING_KINDS, predicting_series
from cytodisk.simulate.random_cells import branching, migrating, random_smooth, random_spiky
from cytodisk.simulate.random_masks import KINDS, random_mask
from cytodisk.simulate.signals import (
    SimulatedCell,
    cell_with_cortex,
    cell_with_signal,
    linear_signal,
    ring_signal,
)
from cytodisk.simulate.stress_series import STRESS_KINDS
from cytodisk.simulate.waves.wave_series import WAVE_KINDS, wave_series

__all__ = [
    "CELL_SHAPES",
    "COUPLINGS",
    "EDGE_KINDS",
    "KINDS",
    "MOVIE_KINDS",
    "NUCLEUS_CASES",
    "NUCLEUS_KINDS",
    "PAIR_CELLS",
    "PAIR_NUCLEI",
    "PASSIVE_KINDS",
    "PREDICTING_KINDS",
    "SERIES_KINDS",
    "STRESS_KINDS",
    "WAVE_KINDS",
    "CellWithNucleus",
    "CellsWithNuclei",
    "DrivenMovie",
    "MovieWithNuclei",
    "PopulationImages",
    "SimulatedCell",
    "SimulatedMovie",
    "SimulatedPopulation",
    "between_nucleus_and_membrane",
    "branching",
    "cell_with_cortex",
    "cell_with_nucleus",
    "cell_with_signal",
    "coupled_series",
    "disk",
    "dumbbell",
    "ellipse",
    "flipped_masks",
    "independent_series",
    "label_image",
    "label_image_with_nuclei",
    "linear_signal",
    "migrating",
    "movie",
    "movie_with_nuclei",
    "passive_signal",
    "population",
    "population_images",
    "predicting_movie",
    "predicting_series",
    "profile_signal",
    "random_mask",
    "random_pair",
    "random_pair_kinds",
    "random_smooth",
    "random_spiky",
    "ring_signal",
    "scaled_up_masks",
    "star",
    "wave_movie",
    "wave_series",
]
