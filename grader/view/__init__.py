"""The live view: what a simulator does, and the graph of what is running, in a browser or in the terminal."""
