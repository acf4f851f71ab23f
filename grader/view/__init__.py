"""The live view: a simulator and the graph of the running nodes, shown in a browser or in the terminal."""
