"""Grade a class: many submissions in parallel. Each result is saved as soon as it is ready."""
