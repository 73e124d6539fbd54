"""The report's figures. Each function returns a Figure whose numbers are all in its tables.

Drawings are module-level functions with their data bound (functools.partial), so that another
process can draw while this one goes on calculating.
"""
