"""Pieces of Markdown."""

NONE = '–'  # no measurement


def table(header, rows, left=1):
    """The first `left` columns are text, the others numbers."""
    lines = ['| ' + ' | '.join(header) + ' |',
             '|' + '|'.join([':--'] * left + ['--:'] * (len(header) - left)) + '|']
    lines += ['| ' + ' | '.join(row) + ' |' for row in rows]
    return '\n'.join(lines) + '\n'


def folded(title, text):
    return '<details><summary>%s</summary>\n\n%s\n</details>\n' % (title, text)


def image(title, file):
    return '![%s](%s)\n' % (title, file)


def ns(value):
    if value is None:
        return NONE
    if value >= 1000:
        return '{:,.0f}'.format(value)
    return ('%.0f' if value >= 100 else '%.1f' if value >= 10 else '%.2f') % value


def ratio(value):
    if value is None:
        return NONE
    form = ('%.0f' if value >= 100 else '%.1f' if value >= 10 else '%.2f' if value >= 0.1
            else '%.2g')
    return form % value


def error(value):
    return NONE if value is None else '0' if value == 0 else '%.1e' % value


def listed(words):
    words = list(words)
    return ' and '.join([', '.join(words[:-1]), words[-1]]) if len(words) > 1 else ''.join(words)
