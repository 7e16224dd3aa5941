"""A batch on a SLURM cluster: run this on a login node, for as long as the batch takes."""

from pathlib import Path

from dask_jobqueue import SLURMCluster

import cytodisk as cd

cluster = SLURMCluster(
    queue="standard",
    cores=16,  # inputs that a job does at a time
    processes=1,
    memory="12 GB",  # 16 × 600 MB, and some for the worker itself
    walltime="12:00:00",
    local_directory="/scratch/local",  # of the node: results are computed there, then copied
    interface="ib0",  # of the network between nodes
    worker_extra_args=["--lifetime", "11h", "--lifetime-stagger", "30m"],  # leave before the job is killed
    scheduler_options={"dashboard_address": ":0"},
)
cluster.adapt(minimum_jobs=0, maximum_jobs=50)
summary = cd.run_batch(
    "study.toml",
    "/shared/out",
    scheduler=cluster.scheduler_address,
    time_limit=3600,
    resume=Path("/shared/out/provenance.json").exists(),
)
print(dict(summary.statuses), *summary.remarks, sep="\n")
