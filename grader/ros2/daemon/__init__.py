"""The daemon: a process that observes the graph, so that verbs do not have to wait for discovery."""
