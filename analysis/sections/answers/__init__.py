"""What became of each prediction, and in which words."""
