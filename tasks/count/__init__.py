"""T1: how many targets are there?"""
