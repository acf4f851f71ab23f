"""The lessons as pages: from lesson.md to HTML. `grader book` writes them to a folder, `grader open` serves them."""
