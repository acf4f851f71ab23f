"""The lessons as HTML pages. `grader book` writes them to a folder, and `grader open` serves them."""
