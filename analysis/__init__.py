"""A data folder in, a report out. It imports none of ours: the files are the interface."""
