"""Pictures of every mode, mask, granularity and hard case."""
