"""Grading: all parts in order, from a folder to a report."""
