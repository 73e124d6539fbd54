"""A scene in; a picture, and what can be seen in it, out. Imports none of our other packages."""
