"""The daemon: a process that knows the graph, so that a verb does not have to wait for discovery."""
