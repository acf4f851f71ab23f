"""Benchmarks that measure ratios within one run: `python -m grader.benchmarks.NAME`."""
