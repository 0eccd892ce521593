"""Questions that take longer than a page waits: each is a command of the command line in a process of its own."""
