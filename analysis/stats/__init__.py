"""Statistics: arrays in, immutable results out. What does not exist is `Undefined`, with why."""
