"""One self-contained HTML page of a movie's study, and the QC flags that stand first on it."""
