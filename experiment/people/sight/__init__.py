"""What simulated eyes see."""
