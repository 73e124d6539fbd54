"""T2: which letter do the targets make?"""
