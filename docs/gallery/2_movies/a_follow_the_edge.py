"""
Follow the edge of a moving cell
================================

Every point of the edge keeps its angle on the disk as the cell moves, so you can follow
its velocity over time. In a simulated movie you know the true velocity, and can compare
the two.
"""

import matplotlib.pyplot as plt
import numpy as np

import cytodisk as cd
from cytodisk.analysis.accuracy import true_edge_velocity

truth = cd.simulate.movie("migrating", seed=0, frames=24)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
print(movie)

# %%
# The outline over time, with the paths of some of its points.
figure, ax = plt.subplots(figsize=(5, 4), layout="constrained")
cd.plot.draw_tracks(
    ax,
    movie.points_yx,
    every=2,
    scale=movie.scale,
)
plt.show()

# %%
# Edge velocity
# -------------
# In each of 60 sectors, in µm/s. Protrusion is positive. Velocity is measured from a
# frame to the next, so the last frame has none.
velocity = cd.edge_velocity(movie, sectors=60)
figure, ax = plt.subplots(figsize=(5, 2.8), layout="constrained")
cd.plot.draw_velocity_map(ax, velocity)
plt.show()

# %%
# Against the truth
# -----------------
# The simulation knows how far each point of the edge moves. The mean in the same
# sectors is what a perfect tracker would measure.
true_px = true_edge_velocity(
    movie.records[0].boundary,
    truth.boundary_yx,
    truth.normal_displacement_px,
    sectors=60,
)
true = true_px * truth.pixel_size_um / truth.frame_interval_s
measured, known = velocity.to_numpy()[:-1].ravel(), true[:-1].ravel()
print(f"correlation with the truth: {np.corrcoef(measured, known)[0, 1]:.3f}")
print(f"typical error: {1000 * np.sqrt(np.mean((measured - known) ** 2)):.1f} nm/s")

figure, ax = plt.subplots(figsize=(3.6, 3.2), layout="constrained")
ax.plot(known, measured, ".", markersize=1.5, color="0.3")
ax.axline((0, 0), slope=1, color="#D55E00", linewidth=0.8)
ax.set(xlabel="true velocity (µm/s)", ylabel="measured (µm/s)", aspect="equal")
plt.show()

# %%
# Error bars
# ----------
# The edge of a mask is uncertain by a fraction of a pixel. ``edge_changes`` estimates
# the error of velocity that follows from how the edge jitters, and the areas won and
# lost, for each sector.
changes = cd.edge_changes(movie, sectors=60)
sector = 10
figure, ax = plt.subplots(figsize=(5, 2.4), layout="constrained")
ax.errorbar(
    changes["time_s"],
    changes["velocity"].sel(sector=sector),
    changes["velocity_error"].sel(sector=sector),
    fmt="o",
    markersize=2,
    linewidth=0.7,
    color="#0072B2",
    label="measured ± standard deviation",
)
ax.plot(changes["time_s"], true[:, sector], color="0.15", linewidth=0.8, label="true")
ax.set(xlabel="time (s)", ylabel="velocity (µm/s)", title=f"sector {sector}")
ax.legend(frameon=False, loc="upper right")
plt.show()
