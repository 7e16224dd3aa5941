"""Numbers of a cell with its nucleus: place of the nucleus, ratios, profiles, shares, polarity."""
