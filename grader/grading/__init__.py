"""Grading: all steps from the folder of a submission to its report."""
