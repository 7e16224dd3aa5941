"""Pictures of predictions: gain by layer, coefficients by lag, the network of signals."""
