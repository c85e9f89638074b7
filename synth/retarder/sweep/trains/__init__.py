"""Large runs of humped trains: batches, each stored as it comes, by local processes or a Dask cluster."""
