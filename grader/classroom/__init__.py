"""A whole class: many submissions, graded side by side, each result kept as it comes."""
