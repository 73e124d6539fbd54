"""One file each command of the program; cli.py imports only the one that runs."""
