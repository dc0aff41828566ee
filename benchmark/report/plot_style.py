"""One look for all plots of the report: a colour for each method, a marker for each mode.

Import it before matplotlib.pyplot: it chooses the backend, which needs no screen.
"""
import math

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
from matplotlib.colors import to_rgb  # noqa: E402
from matplotlib.ticker import LogLocator, NullFormatter  # noqa: E402

DPI = 150
WIDE = (9.0, 5.6)  # inches
TALL = (9.0, 7.2)
INK = '#222222'
FAINT = '#767676'  # for remarks; dark enough to be read on white

# Okabe and Ito's palette, told apart by colour-blind readers too; without its yellow, which is too
# light for lines on white.
BLUE, VERMILLION, GREEN, ORANGE = '#0072B2', '#D55E00', '#009E73', '#E69F00'
PURPLE, SKY, BLACK, BROWN = '#CC79A7', '#56B4E9', '#000000', '#7A4A1E'
INDIGO, WINE = '#332288', '#882255'
# For series that are neither methods nor modes, in this order.
SERIES_COLORS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK, BROWN)
SERIES_MARKERS = ('o', 's', '^', 'D', 'v', 'P', 'X', '*')

METHODS = {  # name in the CSV: (name for readers, colour)
    'virtual_work': ('virtual work', BLUE),
    'generated': ('generated code', WINE),
    'lagrange': ('Lagrange', INDIGO),
    'kdl_chain': ('KDL chain', VERMILLION),
    'kdl_chain_lumped': ('KDL chain, lumped', ORANGE),
    'kdl_tree': ('KDL tree', BROWN),
    'mujoco': ('MuJoCo', GREEN),
    'dart': ('DART', PURPLE),
    'pinocchio': ('Pinocchio', BLACK),
    'rbdl': ('RBDL', SKY),
    # Only of closed loops, which KDL is not measured on: it may have KDL's colour.
    'maximal_coordinates': ('one system of all bodies', VERMILLION),
    'dense': ("a user's dense code", ORANGE),
}
OTHER_COLOR = FAINT

MODES = {  # name in the CSV: (name for readers, marker)
    'single': ('one sample', 'o'),
    'block_soa_baseline': ('block, arrays, baseline', 's'),
    'block_soa_avx2': ('block, arrays, AVX2', '^'),
    'block_soa_avx512': ('block, arrays, AVX-512', 'D'),
    'block_rows_baseline': ('block, rows, baseline', 'P'),
    'block_rows_avx2': ('block, rows, AVX2', 'v'),
    'block_rows_avx512': ('block, rows, AVX-512', 'X'),
    'completed': ('one sample, completed first', 's'),
    'completion': ('completion', 'D'),
}
OTHER_MARKER = '*'


def method_name(method):
    return METHODS[method][0] if method in METHODS else method.replace('_', ' ')


def method_color(method):
    return METHODS[method][1] if method in METHODS else OTHER_COLOR


def readable(color):
    """A colour of the palette, dark enough for text on white."""
    return tuple(0.72 * part for part in to_rgb(color))


def mode_name(mode):
    return MODES[mode][0] if mode in MODES else mode.replace('_', ' ')


def mode_marker(mode):
    return MODES[mode][1] if mode in MODES else OTHER_MARKER


def use_style():
    plt.rcParams.update({
        'font.size': 10, 'axes.titlesize': 12, 'axes.titleweight': 'bold',
        'axes.titlelocation': 'left', 'axes.titlepad': 10, 'axes.labelsize': 10.5,
        'xtick.labelsize': 9.5, 'ytick.labelsize': 9.5, 'legend.fontsize': 9,
        'legend.frameon': True, 'legend.framealpha': 0.92, 'legend.edgecolor': '0.85',
        'text.color': INK, 'axes.labelcolor': INK, 'axes.edgecolor': '0.5',
        'xtick.color': INK, 'ytick.color': INK,
        'axes.spines.top': False, 'axes.spines.right': False,
        'axes.grid': True, 'axes.axisbelow': True, 'grid.color': '0.88', 'grid.linewidth': 0.7,
        'lines.linewidth': 1.6, 'lines.markersize': 7, 'figure.facecolor': 'white',
    })


def new_figure(size=WIDE, rows=1, columns=1, **options):
    """(figure, axes) that leave room for all labels."""
    use_style()
    return plt.subplots(rows, columns, figsize=size, constrained_layout=True, **options)


def label_ticks(axis, decades, power=False):
    """Numbers at 1, 2 and 5 on a logarithmic axis that spans few decades; as powers of ten or
    plain."""
    if decades < 3.5:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(_powers if power else _plain)
    axis.set_minor_formatter(NullFormatter())


def _plain(value, _position=None):
    return '{:,.0f}'.format(value) if value >= 1000 else '{:g}'.format(value)


def _powers(value, _position=None):
    exponent = math.floor(math.log10(value) + 1e-9)
    digit = round(value / 10.0 ** exponent)
    return '$%s10^{%d}$' % ('' if digit == 1 else r'%d\times ' % digit, exponent)


def save(figure, path):
    """Writes the PNG, and frees the figure."""
    figure.savefig(str(path), dpi=DPI)
    plt.close(figure)
