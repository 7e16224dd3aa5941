"""Correlation over lags, its peaks, and what chance gives."""
