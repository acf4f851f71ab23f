"""Mutation run: is each piece of the code that makes diagnoses needed by some case?

`python -m grader.tests.mutation` changes that code in one place at a time and judges the cases again, from recordings
that are made once. A change that no case notices is printed: a case is missing, or the code is not needed.
"""
