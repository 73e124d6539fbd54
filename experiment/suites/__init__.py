"""What an object of each kind has to keep to, tried on it: ours and a stranger's alike."""
