"""nbgrader with this course: what is released, kernels in a cell, scores of the grader's own, feedback."""
