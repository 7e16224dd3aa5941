"""
Protrusion events, and the signal around them
=============================================

An event is a run of frames in which a sector of the edge protrudes, or retracts. The
mean signal around the onsets shows what comes before and what comes after.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("fluctuating", seed=0, frames=60, speed_px=0.5, lag_frames=4)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
signal = cd.sample_movie(movie, cd.polar_windows(layers=5, sectors=30), truth.signal)[
    "mean"
]
velocity = cd.edge_velocity(movie, sectors=30)

# %%
# One row for each event. Events of neighbouring sectors at the same time belong to one
# patch.
events = cd.edge_events(velocity)
print(
    events[["sector", "kind", "onset_s", "duration", "peak_velocity", "patch"]].head()
)
print(events.groupby("kind")["patch"].nunique())

figure, ax = plt.subplots(figsize=(5.6, 2.8), layout="constrained")
cd.plot.draw_events(ax, velocity, events)
plt.show()

# %%
# The mean signal around the onsets of protrusion. The simulated signal follows the
# velocity by four frames (20 s). The band comes from resampling whole patches, because
# the events of a patch are not independent.
around = cd.average_around(signal.sel(channel="edge"), events, before=10, after=15)
figure, ax = plt.subplots(figsize=(6, 2.8), layout="constrained")
lines = cd.plot.draw_event_average(ax, around, label="mean signal")
handles = [*lines, *cd.plot.band_key(around)]
ax.legend(handles=handles, loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
plt.show()
