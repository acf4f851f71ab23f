"""Grading: connect all the parts, from the folder of a submission to its report."""
