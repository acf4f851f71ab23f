"""The test bench: run a student's tests on a right node and on broken ones, without revealing which is which."""
