"""Trials: run the simulator and a student's nodes on one clock, or call a student's function or program."""
