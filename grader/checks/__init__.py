"""Checks: pure functions of the evidence of a submission. `judge.judge` runs them; each subject has one module."""
