"""What is wrong with an input, in one line for the user."""


class ReportError(Exception):
    """What is wrong with an input, in one line."""
