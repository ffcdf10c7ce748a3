"""The exceptions of the package."""


class Error(Exception):
    """A simulation, a run's files or a tool cannot go on; the message is the program's one line."""


class RunError(Error):
    """A folder or file of a run is missing, cannot be read or cannot be written; the message is one line."""
