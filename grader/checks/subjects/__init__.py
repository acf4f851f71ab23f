"""One module per subject that is judged; each defines its kinds of checks."""
