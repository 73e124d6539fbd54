"""What a frame needs, and in which order."""
