"""`grader open`: a page for learning, with the lesson, the verdict after each save, and a live turtle."""
