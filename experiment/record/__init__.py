"""What is recorded, how it stays whole, and who may read it."""
