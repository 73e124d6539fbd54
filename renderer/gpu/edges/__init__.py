"""What is done to a frame along the edges of things."""
