"""Self-study: the learner's workspace, steps, hints and progress."""
