"""Headings, texts, tables and pictures, as Markdown or as one HTML page that needs nothing else."""
import base64
import html
import os
import re


class Heading:
    def __init__(self, level, text):
        self.level = level
        self.text = text

    @property
    def anchor(self):
        return re.sub(r'[^\w]+', '-', self.text.lower()).strip('-')


class Text:
    """A paragraph; words in ` ` are code."""

    def __init__(self, text, kind=''):
        self.text = text
        self.kind = kind  # class of the HTML


class Items:
    """A list of paragraphs."""

    def __init__(self, items):
        self.items = items


class Table:
    """Cells are texts; the first `names` columns are names, the others numbers."""

    def __init__(self, header, rows, names=1):
        self.header = header
        self.rows = rows
        self.names = names


class Figure:
    def __init__(self, path, caption, half=False):
        self.path = path  # of an SVG
        self.caption = caption
        self.half = half  # two stand side by side


def number_text(value, digits=4):
    """A number for people: so many digits, without an exponent where it is short."""
    if value is None or value != value:
        return '–'
    if value == 0:
        return '0'
    text = '%.*g' % (digits, value)
    mantissa, _, exponent = text.partition('e')
    if exponent and 0 < int(exponent) < 7:
        text = '%.0f' % float(text)
    elif exponent:
        text = '%s·10^%d' % (mantissa, int(exponent))
    return text.replace('-', '−')


# --- Markdown ----------------------------------------------------------------------------------------


def _cell(text):
    return str(text).replace('|', '\\|').replace('\n', ' ')


def _table_lines(table):
    rule = ['---' if i < table.names else '---:' for i in range(len(table.header))]
    return ['| ' + ' | '.join(_cell(cell) for cell in row) + ' |'
            for row in [table.header, rule] + table.rows]


def as_markdown(title, blocks, folder):
    """The text of a Markdown file in `folder`."""
    lines = ['# ' + title, '']
    for block in blocks:
        if isinstance(block, Heading):
            lines += ['#' * block.level + ' ' + block.text, '']
        elif isinstance(block, Text):
            lines += [block.text, '']
        elif isinstance(block, Items):
            lines += ['- ' + item for item in block.items] + ['']
        elif isinstance(block, Table):
            lines += _table_lines(block) + ['']
        elif isinstance(block, Figure):
            place = os.path.relpath(block.path, folder).replace(' ', '%20')
            lines += ['![%s](%s)' % (block.caption.replace('`', ''), place), '', '*%s*' % block.caption, '']
    return '\n'.join(lines)


# --- HTML --------------------------------------------------------------------------------------------


def _inline(text):
    text = html.escape(text, quote=False).replace('N m', 'N\u00a0m')
    text = re.sub(r'·10\^(−?\d+)', r'·10<sup>\1</sup>', text)
    return re.sub(r'`([^`]*)`', r'<code>\1</code>', text)


def _html_table(table):
    def row(tag, cells):
        kinds = ['name' if i < table.names else 'number' for i in range(len(cells))]
        return '<tr>%s</tr>' % ''.join('<%s class="%s">%s</%s>' % (tag, kind, _inline(str(cell)), tag)
                                       for kind, cell in zip(kinds, cells))
    return ('<div class="wide"><table><thead>%s</thead><tbody>%s</tbody></table></div>'
            % (row('th', table.header), '\n'.join(row('td', cells) for cells in table.rows)))


def _html_figure(figure):
    with open(figure.path, 'rb') as file:
        data = base64.b64encode(file.read()).decode('ascii')
    return ('<figure class="%s"><img alt="%s" src="data:image/svg+xml;base64,%s"><figcaption>%s</figcaption>'
            '</figure>' % ('half' if figure.half else 'full',
                           html.escape(figure.caption.replace('`', '')), data, _inline(figure.caption)))


def _html_block(block):
    if isinstance(block, Heading):
        return '<h%d id="%s">%s</h%d>' % (block.level, block.anchor, _inline(block.text), block.level)
    if isinstance(block, Text):
        return '<p class="%s">%s</p>' % (block.kind, _inline(block.text))
    if isinstance(block, Items):
        return '<ul>%s</ul>' % ''.join('<li>%s</li>' % _inline(item) for item in block.items)
    if isinstance(block, Table):
        return _html_table(block)
    return _html_figure(block)


def _contents(blocks):
    links = ['<li class="level%d"><a href="#%s">%s</a></li>' % (b.level, b.anchor, _inline(b.text))
             for b in blocks if isinstance(b, Heading)]
    return '<nav><ul>%s</ul></nav>' % ''.join(links)


def as_html(title, blocks):
    """The text of an HTML page with all of its style and pictures in it."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'page.css'), encoding='utf-8') as file:
        style = file.read()
    parts, figures = [], []
    for block in list(blocks) + [None]:
        if isinstance(block, Figure):
            figures.append(_html_block(block))
            continue
        if figures:
            parts.append('<div class="figures">%s</div>' % '\n'.join(figures))
            figures = []
        if block is not None:
            parts.append(_html_block(block))
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            '<title>%s</title><style>\n%s</style></head>\n<body>%s<main><h1>%s</h1>\n%s\n</main></body></html>\n'
            % (html.escape(title), style, _contents(blocks), html.escape(title), '\n'.join(parts)))
