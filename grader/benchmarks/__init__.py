"""Benchmarks that compare costs measured in the same run: `python -m grader.benchmarks.NAME`."""
