"""The lessons as HTML pages. `grader book` writes the pages to a folder, and `grader open` serves them."""
