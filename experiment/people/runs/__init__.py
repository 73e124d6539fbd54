"""Many simulated participants at once."""
