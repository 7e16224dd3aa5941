import matplotlib.pyplot as plt

import cytodisk as cd

truth = cd.simulate.movie("fluctuating", seed=1, frames=8, speed_px=1.2)
movie = cd.map_movie(truth.masks, pixel_size_um=truth.pixel_size_um, frame_interval_s=truth.frame_interval_s)
points, following = movie.points_yx[3:5]
normals = movie.normals_yx[3]
along = ((following - points) * normals).sum(axis=1)
figure, ax = plt.subplots(figsize=(4, 3.6), layout="constrained")
cd.plot.draw_velocity_arrows(
    ax,
    points,
    following,
    normals,
    along,
    movie[3].outline_yx,
    movie[4].outline_yx,
    pixel_size_um=truth.pixel_size_um,
    every=2,
)
