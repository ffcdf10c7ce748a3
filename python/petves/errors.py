"""The exception of the package."""


class Error(Exception):
    """A simulation, a run's files or a tool cannot go on; the message is the program's one line."""
