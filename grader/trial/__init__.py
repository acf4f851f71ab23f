"""A trial: one run of the simulator and the student's node on one clock."""
