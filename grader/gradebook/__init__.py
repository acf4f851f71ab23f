"""nbgrader for this course: releases, kernels in cells, scores confirmed by the grader, and feedback."""
