"""What a trial cannot be set for."""


class NoScene(ValueError):
    """A world with these parameters holds no scene in which a task can be set, in one line: table,
    key = value, what was expected."""
