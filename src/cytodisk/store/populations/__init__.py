"""The study of a population: cells by condition and experiment, and what differs between conditions."""
