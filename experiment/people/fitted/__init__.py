"""A simulated participant's parameters, and how they follow from people's data."""
