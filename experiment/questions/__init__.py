"""Kinds of questions that a study may ask."""
