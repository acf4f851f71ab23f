"""The test bench: run a student's tests on a correct node and on broken nodes, without revealing which is which."""
