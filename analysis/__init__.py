"""A data folder in, a report out. Imports none of our other packages: the files are the interface."""
