"""Runs a study: config, design, session, display, records, participants, commands."""
