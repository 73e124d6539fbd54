"""Commands that read what was recorded, or say how much of it a study needs."""
