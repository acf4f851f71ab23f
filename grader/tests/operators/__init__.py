"""Operators: each adds a typical mistake of learners to a correct package, at a known place."""
