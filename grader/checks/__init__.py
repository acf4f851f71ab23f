"""Checks: pure functions of the evidence about a submission.

`judge.judge` runs the checks, and the checks of each subject are in a module of their own.
"""
