"""Learning alone: the learner's workspace, the steps, hints and progress."""
