"""Learning alone: a workspace of one's own, steps in order, hints, progress."""
