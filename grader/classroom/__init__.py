"""Grade a whole class: many submissions in parallel, with each result saved as soon as it is ready."""
