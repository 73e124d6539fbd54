"""How right statistics are: sizes of tests, and against other programs."""
