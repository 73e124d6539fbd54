"""The report's figures, as Vega-Lite specifications; all their numbers stand in its tables."""
