"""Benchmarks that measure speeds as ratios, within one run: `python -m grader.benchmarks.NAME`."""
