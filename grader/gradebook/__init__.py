"""nbgrader for this course: releases, kernels in sandbox cells, scores confirmed by the grader, and feedback."""
