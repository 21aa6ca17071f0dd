"""The error of a wrong command line or a missing input."""


class BenchError(Exception):
    """A mistake that the user can correct; its message is one line."""
