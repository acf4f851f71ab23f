"""Operators: each makes a correct package wrong in one known place, as learners do."""
