import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("fluctuating", seed=0, frames=50, speed_px=0.5)
movie = cd.map_movie(truth.masks, pixel_size_um=truth.pixel_size_um, frame_interval_s=truth.frame_interval_s)
velocity = cd.edge_velocity(movie, sectors=40)
figure, ax = plt.subplots(figsize=(5.6, 2.6), layout="constrained")
cd.plot.draw_events(ax, velocity, cd.edge_events(velocity))
