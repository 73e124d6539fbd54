"""What `check` finds out about a study's scenes before anybody is invited."""
