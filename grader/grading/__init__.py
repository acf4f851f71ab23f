"""Grading: it puts all parts together, from a folder to a report."""
