"""What students hand in, made up by a machine: names, modes, archives, notebooks, sources, install trees, recordings.

    python -m grader.tests.fuzz TARGET --minutes N      with atheris, which looks for new paths through the code
    python -m pytest grader/tests/fuzz                  a few hundred of each, the same every time

A target gets bytes and does with them what a command does. It has found a fault where something else than an error of
ours comes out, where the grading of a submission ends with `error`, or where that takes too long or too much memory.
"""
