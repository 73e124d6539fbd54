"""What simulated people can do: look, count, point, walk, remember. Tasks are done with these."""
