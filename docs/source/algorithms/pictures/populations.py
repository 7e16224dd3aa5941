from itertools import combinations

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

layers, sectors, each = 6, 24, 5
truth = cd.simulate.population(experiments=each, cells=12, layers=layers, sectors=sectors, effect=2.0, seed=4)
pop = cd.Population(truth.values, truth.cells)
found = cd.compare_conditions(pop, "control", "drug")

# Means of experiments, and the largest score for each way to exchange their labels.
cells = truth.values.to_numpy().reshape(len(truth.cells), -1)
number = truth.cells["experiment"].factorize()[0]
means = np.array([cells[number == k].mean(axis=0) for k in range(2 * each)])
shared = np.median(means.var(axis=0, ddof=1)) * 2 / each
largest = []
for chosen in combinations(range(2 * each), each):
    drug = np.isin(np.arange(2 * each), chosen)
    difference = means[drug].mean(axis=0) - means[~drug].mean(axis=0)
    own = (means[drug].var(axis=0, ddof=1) + means[~drug].var(axis=0, ddof=1)) / each
    largest.append(np.abs(difference / np.sqrt((own + shared) / 2)).max())
observed = largest[-1]  # the drug's experiments come last

figure = plt.figure(figsize=(6.6, 2.5), layout="constrained")
left, middle, right = figure.subplots(1, 3, width_ratios=(0.9, 1, 1.25))
window = int(np.flatnonzero(truth.region.to_numpy().ravel())[3])
rng = np.random.default_rng(0)
colours = ("0.45", "#0072B2")
for k in range(2 * each):
    side = k // each
    place = side + 0.75 * ((k % each + 0.5) / each - 0.5)
    of = cells[number == k, window]
    left.plot(place + rng.uniform(-0.03, 0.03, len(of)), of, ".", color=colours[side], markersize=2)
    left.plot(place, means[k, window], "o", color=colours[side], markersize=5, markeredgecolor="0.1")
left.set_xticks([0, 1], ["control", "drug"])
left.set(ylabel="signal (a.u.)", title="a window")

middle.hist(largest, 30, color="0.75")
middle.axvline(observed, color="#0072B2")
reach = sum(value >= observed * (1 - 1e-9) for value in largest)
middle.annotate(
    f"observed:\n{reach} of {len(largest)}\nreach it",
    (observed, 0.97),
    xycoords=("data", "axes fraction"),
    xytext=(-4, 0),
    textcoords="offset points",
    ha="right",
    va="top",
    color="#0072B2",
)
middle.set(xlabel="largest |t| of all windows", ylabel="ways to exchange", title="exchanged labels")

grid = cd.polar_windows(layers=layers, sectors=sectors)
drawn = cd.plot.draw_difference(right, cd.plot.DifferenceMap.of(found.windows.drop_vars("cluster")), grid)
figure.colorbar(drawn, ax=right, label="drug − control (a.u.)", shrink=0.8)
right.set_title("difference")
