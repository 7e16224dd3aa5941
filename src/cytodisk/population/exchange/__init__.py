"""Labels exchanged between experiments, and the p-values that follow."""
