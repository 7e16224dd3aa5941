"""
Waves along the edge
====================

Does the edge only flicker, or do waves run around the cell? ``edge_waves`` finds the
strongest wave, its speed and its direction, and says what chance would give. Three
simulated cells: in one a wave runs, in one it stands, in one there is none.
"""

import matplotlib.pyplot as plt

import cytodisk as cd


def velocity_of(cell):
    """Velocity of the edge, as it is measured from masks."""
    movie = cd.map_movie(
        cell.masks,
        pixel_size_um=cell.pixel_size_um,
        frame_interval_s=cell.frame_interval_s,
    )
    return cd.edge_velocity(movie, sectors=36)


small = {"frames": 60, "radius_px": 30, "edge_speed_px": 0.6, "noise": 1.0}
cells = {
    "a wave runs": cd.simulate.wave_movie("running", 0, mode=2, direction=-1, **small),
    "a wave stands": cd.simulate.wave_movie("standing", 0, mode=2, **small),
    "no wave": cd.simulate.wave_movie("none", 0, persistence_s=200, **small),
}

# %%
# Noise is as large as the wave itself. Crests that run are slanted lines, downwards
# here: towards lower sectors.
figure, axes = plt.subplots(1, 3, figsize=(7.4, 2.6), layout="constrained", sharey=True)
velocities, waves = {}, {}
for ax, (name, cell) in zip(axes, cells.items(), strict=True):
    velocity = velocities[name] = velocity_of(cell)
    length = cell.truth["edge_length_um"]
    waves[name] = cd.edge_waves(velocity, cell.frame_interval_s, length)
    image = ax.imshow(
        1000 * velocity.T,
        cmap="RdBu_r",
        vmin=-40,
        vmax=40,
        origin="lower",
        aspect="auto",
        extent=(0, len(velocity) * cell.frame_interval_s, -0.5, 35.5),
    )
    ax.set(xlabel="time (s)", title=name)
axes[0].set_ylabel("sector")
figure.colorbar(image, ax=axes, label="velocity (nm/s)", extend="both")
plt.show()

# %%
# What was found, beside the truth. Speed is that of the strongest wave, whatever its p:
# read ``kind`` and ``p`` first.
for name, found in waves.items():
    print(
        f"{name:14} kind: {found['kind'].item():9} p = {found['p'].item():.3f}   "
        f"mode {found['mode'].item()}, period {found['period_s'].item():.0f} s, "
        f"speed {found['speed_um_s'].item():+.3f} µm/s "
        f"(truth {cells[name].truth['speed_um_s']:+.3f})"
    )

# %%
# Lines along the crests of the wave that runs, and how much of the variance each number
# of waves around the cell has.
found = waves["a wave runs"]
figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 2.6), layout="constrained")
cd.plot.draw_wave_kymograph(
    left, velocities["a wave runs"], found["wave_phase"], by_velocity=True
)
right.bar(found["around"], 100 * found["power"], color="#0072B2")
right.set(xlabel="waves around the cell", ylabel="variance (%)")
plt.show()

# %%
# Inside the cell
# ---------------
# A signal can run inwards or outwards, too. ``disk_waves`` takes all layers, and the
# depth of windows below the edge. This one is simulated by window: a spiral, whose
# crests are 8 µm apart on the way to the centre.
spiral = cd.simulate.wave_series(
    "spiral",
    seed=0,
    frames=60,
    sectors=36,
    layers=6,
    mode=1,
    noise=1.0,
    wavelength_um=8,
)
inside = cd.disk_waves(spiral, depth_um=spiral["depth_um"])
print("kind:", inside["kind"].item(), " p =", inside["p"].item())
print(
    f"inwards {inside['inward_speed_um_s'].item():.3f} µm/s "
    f"(truth {spiral.attrs['inward_speed_um_s']:.3f}), "
    f"around {inside['speed'].item():.4f} turns/s "
    f"(truth {spiral.attrs['speed']:.4f})"
)

figure, axes = plt.subplots(
    1, 5, figsize=(7.4, 1.9), width_ratios=(1, 1, 1, 1, 0.06), layout="constrained"
)
grid = cd.polar_windows(layers=6, sectors=36)
for ax, frame in zip(axes, (20, 25, 30, 35), strict=False):
    cd.plot.draw_phase_on_disk(ax, grid, inside["phase"].isel(time=frame))
    ax.set_title(f"{float(inside['time_s'][frame]):.0f} s")
cd.plot.phase_key(axes[4])
plt.show()
