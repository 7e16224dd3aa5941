"""One self-contained HTML page of a movie's study, and the red flags that stand first on it."""
