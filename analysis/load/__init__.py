"""A data folder in, checked tables out. Reading leaves every file as it was."""
