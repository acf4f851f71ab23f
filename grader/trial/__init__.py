"""A trial: one run of the simulator and the student's node under one clock."""
