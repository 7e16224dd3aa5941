"""Parts of `docs/remeasure.py`: each measures one thing of the paper and writes its tables and pictures."""
