"""
Does one signal predict another?
================================

The past of a signal may help to tell what the edge does next. ``predict`` asks how
much, beyond what the past of the edge itself tells. In this simulated movie the signal
at the edge comes one to three frames before the motion of the edge.
"""

import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.predicting_movie(
    "white", seed=1, frames=100, radius_px=35, strength=0.6
)
movie = cd.map_movie(
    truth.masks,
    pixel_size_um=truth.pixel_size_um,
    frame_interval_s=truth.frame_interval_s,
)
grid = cd.polar_windows(layers=4, sectors=24)
signal = cd.sample_movie(movie, grid, truth.signal)["mean"].sel(channel="source")
velocity = cd.edge_velocity(movie, sectors=24)

# %%
# Ask in both directions. The gain is the logarithm of the error without the source's
# past over the error with it: 0 where the source tells nothing. Chance is what sources
# reach that were shifted in time and around the cell.
forth = cd.predict(signal, velocity, surrogates=199)
back = cd.predict(velocity, signal, surrogates=199)
print(f"gain of the simulation: {truth.truth['gain']:.2f}, back {0:.2f}")
print(f"gain of layer 0:        {forth['gain'][0]:.2f}, back {back['gain'][0]:.2f}")

# %%
# The signal predicts the edge in the outer layers, where the simulation puts it. The
# edge does not predict the signal there. The coefficients say when: the edge moves out
# one to three frames after a bright signal, and then goes back to where it rests.
figure, (left, right) = plt.subplots(1, 2, figsize=(7, 2.8), layout="constrained")
for found, label, colour in (
    (forth, "signal → edge", "#D55E00"),
    (back, "edge → signal", "#0072B2"),
):
    left.plot(found["layer"], found["gain"], "o-", color=colour, label=label)
    left.plot(found["layer"], found["threshold"], ":", color=colour)
left.set(xlabel="layer (0 at the edge)", ylabel="gain (nats)", xticks=range(4))
left.legend(frameon=False, title="dotted: 5 % limit")

outer = forth.sel(layer=0)
scale = float(signal.sel(layer=0).std() / velocity.std())  # to standard deviations
right.vlines(
    outer["lag"] * truth.frame_interval_s,
    scale * outer["coefficient_low"],
    scale * outer["coefficient_high"],
    color="#D55E00",
)
right.plot(
    outer["lag"] * truth.frame_interval_s,
    scale * outer["coefficient"],
    "o",
    color="#D55E00",
)
right.axhline(0, color="0.6", linewidth=0.6)
right.set(xlabel="signal earlier by (s)", ylabel="coefficient (sd per sd)")
plt.show()

# %%
# A third signal that drives both makes one predict the other, although neither has to
# do with the other. If you have measured the third, give it.
driven = cd.simulate.predicting_series(
    "ar1",
    seed=0,
    frames=150,
    layers=1,
    sectors=60,
    coupling="common driver",
    strength=0.7,
)
alone = cd.predict(driven.source, driven.target, surrogates=199)
given = cd.predict(driven.source, driven.target, [driven.driver], surrogates=199)
print(f"driver not given: gain {alone['gain'].item():.3f}, p = {alone['p'].item():.3f}")
print(f"driver given:     gain {given['gain'].item():.3f}, p = {given['p'].item():.3f}")
