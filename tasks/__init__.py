"""The tasks of a study: each generates its scene, takes events, asks, and scores the answer."""
