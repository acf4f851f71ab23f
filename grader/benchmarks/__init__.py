"""Benchmarks: speeds as ratios, measured in one run: `python -m grader.benchmarks.NAME`."""
