"""`grader open`: one page to learn on, with the lesson, the verdict after each save, and a live turtle."""
