"""Grade a whole class: many submissions side by side, with each result saved as soon as it is ready."""
