"""T4: how many targets are in the building?"""
