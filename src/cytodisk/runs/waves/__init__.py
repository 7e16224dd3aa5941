"""`cytodisk waves`: do waves run along the edge of the cells of a movie, or through their signals?"""
