"""Fuzzing with generated submissions: names, modes, archives, notebooks, sources, install trees, recordings.

    python -m grader.tests.fuzz TARGET --minutes N      with atheris, which searches for new paths through the code
    python -m pytest grader/tests/fuzz                  a few hundred inputs per target, the same in every run

A fuzz target processes bytes as a command would. A finding is an exception that is not a GraderError, a submission
that ends with `error`, or a run that takes too much time or memory.
"""
