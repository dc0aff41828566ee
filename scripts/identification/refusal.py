"""What is wrong with an input, in one line."""


class Refusal(Exception):
    """Ends the program with one line and exit code 1."""


def in_quotes(name):
    return "'%s'" % name


def listed(names):
    return ', '.join(in_quotes(name) for name in names)
