"""
Is it different?
================

A drug, six days, a control dish and a treated dish each day: where in the cell does the
signal differ, and can that be concluded? The test exchanges whole experiments, not
cells, because cells of one dish are not independent. On the command line, type
``cytodisk population maps --compare control,drug --align nucleus -o atlas``.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd

# %%
# 6 days with both conditions, so that experiments are pairs. A tenth of the variance
# lies between days. The drug raises the signal in a region near the membrane. Cells lie
# turned on the slide; their nuclei say which way.
truth = cd.simulate.population(
    experiments=6,
    paired=True,
    cells=12,
    layers=6,
    sectors=24,
    effect=1.0,
    turned="nucleus",
    seed=2,
)
print(truth.cells[["cell", "condition", "experiment", "area"]].iloc[::40])

# %%
# A population is values and a table. ``cd.open_population("maps")`` reads your own.
# ``align`` turns each cell, so that sector 0 begins away from its nucleus.
pop = cd.Population(truth.values, truth.cells, scalars=["area"]).align("nucleus")
print(pop)
print("cells without a direction:", (pop.alignment["status"] != "ok").sum())

# %%
# The comparison says first what this number of experiments can reach.
found = cd.compare_conditions(pop, "control", "drug")
for sentence in found.sentences:
    print("*", sentence)
for warning in found.warnings:
    print("WARNING", warning)

# %%
# Where
# -----
# The mean of each condition, and the difference. Thin lines surround windows with
# p < 0.05 after correction for all windows, broken lines clusters of windows.
grid = cd.polar_windows(layers=6, sectors=24)
atlas = pop.atlas().squeeze("channel")
difference = cd.plot.DifferenceMap.of(found.windows)
figure, axes = plt.subplots(1, 3, figsize=(7.2, 2.9), layout="constrained")
drawn = cd.plot.draw_atlas(axes[:2], atlas, grid)
figure.colorbar(drawn[0], ax=axes[:2], label="signal (a.u.)", shrink=0.7)
drawn = cd.plot.draw_difference(axes[2], difference, grid)
figure.colorbar(drawn, ax=axes[2], label="drug − control (a.u.)", shrink=0.7)
axes[2].set_title("difference")
axes[2].legend(
    handles=cd.plot.difference_key(difference),
    loc="upper center",
    bbox_to_anchor=(0.5, -0.06),
    frameon=False,
)
plt.show()

# %%
# The planted region, and what came back.
region = truth.region.to_numpy()
significant = found.windows["p_fwer"].to_numpy() < 0.05
print("windows of the region:", region.sum(), "; found:", (significant & region).sum())
print("found outside of it:", (significant & ~region).sum())
print(found.clusters.loc[found.clusters["p"] < 0.05, ["sectors", "layers", "p"]])

# %%
# By layer, and one number a cell
# -------------------------------
# A thin line is an experiment. In the right picture small dots are cells, large marks
# the means of experiments, joined where they are of one day.
scalars = pop.scalar_table()
layers = [f"layer_{layer}_signal" for layer in range(6)]
profiles = pop.cells[["condition", "experiment"]].join(scalars[layers])
profiles = profiles.melt(["condition", "experiment"], var_name="layer")
profiles["layer"] = profiles["layer"].str.extract(r"(\d+)").astype(int)
cells = pop.cells[["condition", "experiment"]].join(scalars["edge_to_centre_signal"])
figure, axes = plt.subplots(1, 2, figsize=(6.6, 2.8), layout="constrained")
lines = cd.plot.draw_condition_profiles(axes[0], profiles, label="signal (a.u.)")
axes[0].set_xlabel("layer, 0 at the membrane")
axes[0].legend(handles=cd.plot.condition_key(lines), frameon=False, fontsize=6)
cd.plot.draw_super_plot(
    axes[1], cells, "edge_to_centre_signal", label="edge / centre of the cell"
)
plt.show()

# %%
# How large
# ---------
# Effect sizes with their 95 % intervals, over experiments. An interval that includes 0
# and large effects says that you do not know yet.
figure, ax = plt.subplots(figsize=(5.2, 2.8), layout="constrained")
cd.plot.draw_effect_sizes(ax, found.scalars)
plt.show()

# %%
# What three days would have shown
# --------------------------------
# The same data, without half of the days. No effect, however large, can be significant.
days = [f"experiment {number}" for number in (1, 2, 3)]
few = pop.select(np.isin(pop.cells["experiment"], days))
print(cd.compare_conditions(few, "control", "drug").sentences[0])

# %%
# What cells as units would have said
# -----------------------------------
# Two groups of days without any drug: there is nothing to find. Cells find it.
controls = pop.select(pop.cells["condition"] == "control")
half = np.where(np.isin(controls.cells["experiment"], days), "early", "late")
controls = controls.with_cells(controls.cells.assign(condition=half))
for unit in ("cell", "experiment"):
    nothing = cd.compare_conditions(
        controls, "early", "late", unit=unit, permutations=999
    )
    smallest = nothing.windows["p_fwer"].min().item()
    print(f"unit {unit}: smallest p of any window {smallest:.3f}")
