"""Accuracy against time, and speed against the papers and against peers."""
