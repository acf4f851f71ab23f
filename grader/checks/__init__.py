"""Checks: pure functions of the evidence about a submission. `judge.judge` runs them; each subject has one module."""
