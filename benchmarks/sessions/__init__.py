"""What sessions cost, real and simulated, and what simulated people do."""
