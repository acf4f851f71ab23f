"""The daemon: a process that keeps the graph in mind, so that a look at it need not wait until all is discovered."""
