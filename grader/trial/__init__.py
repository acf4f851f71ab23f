"""A trial: one run of simulator and node under one clock."""
