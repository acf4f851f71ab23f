"""Mutation run: does some case or test need each piece of the code that makes diagnoses?

`python -m grader.tests.mutation` changes that code in one place at a time: it removes or renames a diagnosis, removes
its place, makes a condition always true or always false, or changes a number or a comparison. Then it judges the cases
again from recordings that are made once. It asks the tests in grader/tests/checks about the changes that no case
noticed. It prints the changes that nothing noticed: a case or a test is missing, or the code is not needed.

mutants.py says what is not changed (mainly words), and equivalent.toml lists single changes that have no effect. The
modules that only read (code.py, scene.py, setup_py.py, trajectory.py, ...) make no diagnosis and are not changed.

Measured in November 2026, module by module: of 3,461 changes, 89 were noticed by no case and no test, which is 2.6 %.
Most are in eight.py (20 of 134), square.py (15 of 131), entry_point.py (12 of 207) and path.py (11 of 232). These
figures do not include the tests that were added later.
"""
