"""Pictures of every technique, parameter, look and hard case."""
