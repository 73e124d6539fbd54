"""What rolls, floats and flies."""
