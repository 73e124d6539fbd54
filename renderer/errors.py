"""What a frame cannot be drawn for."""


class CannotDraw(ValueError):
    """A technique with these parameters cannot draw this scene, in one line: key = value, what was
    expected."""
