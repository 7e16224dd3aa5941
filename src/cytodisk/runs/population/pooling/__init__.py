"""Numbers of many cells pooled over experiments: means, intervals and tests."""
