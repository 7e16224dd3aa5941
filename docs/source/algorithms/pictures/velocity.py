import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("fluctuating", seed=1, frames=8, speed_px=1.2)
movie = cd.map_movie(truth.masks, pixel_size_um=truth.pixel_size_um, frame_interval_s=truth.frame_interval_s)
figure, ax = plt.subplots(figsize=(4, 3.6), layout="constrained")
cd.plot.draw_velocity_arrows(ax, movie, 3, every=2)
