"""Operators: what makes a right package wrong in one known place, as learners do."""
