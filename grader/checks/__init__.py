"""Checks: pure functions over the evidence of a submission. `judge.judge` runs them; one module a subject."""
