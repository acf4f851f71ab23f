"""Checks: pure functions of the evidence about a submission.

`judge.judge` runs the checks, and each subject has a module with its checks.
"""
