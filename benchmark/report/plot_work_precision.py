"""Error over run time, one plot for each scene."""
import math

from plot_style import (FAINT, INK, label_ticks, method_color, method_name, mode_marker, mode_name,
                        new_figure, readable, save)
from label_placement import LabelPlacement
from matplotlib.lines import Line2D
from report_data import ALL, EFFORTS, LAGRANGE, OWN

PRECISION_NAMES = {'float': 'float', 'double': 'double', 'long_double': 'long double'}
SIZE = (10.5, 9.0)  # inches


def _marker_style(way):
    color = method_color(way.method)
    return {'marker': mode_marker(way.mode), 'linestyle': '', 'clip_on': False,
            'markersize': 7.5 if way.threads == 1 else 5.5,
            'markerfacecolor': 'white' if way.outputs == EFFORTS else color,
            'markeredgecolor': color if way.threads == 1 else INK,
            'markeredgewidth': 1.5 if way.threads == 1 else 1.2,
            'zorder': 4 if way.method == OWN else 5}


def _limits(axes, rows, spare):
    """Sets the limits of the errors, with room for names; returns where errors of zero are drawn,
    or None."""
    axes.set_yscale('log')
    errors = [row.error for row in rows if row.error > 0]
    if not errors:
        axes.set_ylim(1e-20, 1e-14)
        return 1e-19
    low, high = min(errors), max(errors)
    room = max(1.5, (high / low) ** 0.08) * spare
    zero = None
    if any(row.error == 0 for row in rows):
        zero = low / room ** 2
        low = zero
    axes.set_ylim(low / room, high * room)
    label_ticks(axes.yaxis, math.log10(high / low * room ** 2), power=True)
    return zero


def _name_at_right(axes, error, name):
    axes.annotate(name, (1.01, error), xycoords=('axes fraction', 'data'), ha='left', va='center',
                  fontsize=10, weight='bold')


def draw_points(axes, rows, labels, spare, limits_of=None):
    """Draws errors over run times, sets the limits of the errors, those of other rows if given, and
    tells `labels` what not to cover. Returns where errors of zero are drawn, or None."""
    zero = _limits(axes, limits_of or rows, spare)
    for row in rows:
        error = row.error if row.error > 0 else zero
        axes.plot(row.ns, error, **_marker_style(row.way))
        labels.avoid(row.ns, error)
    if zero is not None:
        axes.axhline(zero, color=FAINT, linewidth=1, linestyle=':', zorder=1)
        _name_at_right(axes, zero, 'exactly 0')
        low, high = axes.get_xlim()
        for i in range(81):  # no name on the line
            labels.avoid(low * (high / low) ** (i / 80), zero)
    return zero


def _name_precisions(axes, rows):
    """Names the bands of the number types at the right edge; where the recursion is, for the other
    route rounds all of its results to double."""
    rows = [row for row in rows if row.way.method != LAGRANGE]
    for precision, name in PRECISION_NAMES.items():
        errors = [row.error for row in rows if row.way.precision == precision and row.error > 0]
        if not errors:  # not measured, or all at the line of zeros
            continue
        middle = math.sqrt(min(errors) * max(errors))
        _name_at_right(axes, middle, name)


def _name_points(labels, rows, zero):
    for row in rows:
        if row.way.mode != 'single':
            continue
        name = method_name(row.way.method)
        if row.way.method == OWN:
            name += ', one sample'
        labels.want(row.ns, row.error if row.error > 0 else zero, name,
                    readable(method_color(row.way.method)))


def _name_rounded(labels, rows):
    """Tells why there are points of long double among those of double."""
    for row in rows:
        if row.error > 0 and (row.way.method, row.way.precision, row.way.outputs) == (
                LAGRANGE, 'long_double', ALL):
            labels.want(row.ns, row.error, 'Lagrange in long double,\nresults rounded to double',
                        readable(method_color(LAGRANGE)))


def _legend(figure, rows):
    own = method_color(OWN)
    plain = {'linestyle': '', 'markersize': 7.5, 'markeredgewidth': 1.5}
    modes = dict.fromkeys(row.way.mode for row in rows)
    entries = [Line2D([], [], marker=mode_marker(mode), color=own, label=mode_name(mode), **plain)
               for mode in modes]
    entries.append(Line2D([], [], marker='o', color=FAINT, label='efforts and all reactions',
                          **plain))
    entries.append(Line2D([], [], marker='o', color=FAINT, markerfacecolor='white',
                          label='efforts only (hollow)', **plain))
    if any(row.way.threads > 1 for row in rows):
        threads = sorted({row.way.threads for row in rows} - {1})
        entries.append(Line2D(
            [], [], marker='o', linestyle='', color=FAINT, markersize=5.5, markeredgecolor=INK,
            label='%s threads (small, dark rim)' % ', '.join(map(str, threads))))
    figure.legend(handles=entries, loc='lower center',
                  ncol=3, fontsize=9)


def plot_work_precision(data, scene, title, path):
    rows = data.of_scene(scene)
    doubles = [row for row in rows if row.way.precision == 'double']
    figure, (upper, lower) = new_figure(SIZE, rows=2, sharex=True,
                                         gridspec_kw={'height_ratios': (1, 1.25)})
    figure.get_layout_engine().set(rect=(0.01, 0.12, 0.98, 0.87), hspace=0.05)
    upper.set_title('%s: error over run time, all number types' % title)
    lower.set_title('%s: the same, double only, solvers named' % title)
    times = [row.ns for row in rows]
    lower.set_xscale('log')
    lower.set_xlim(min(times) / 1.35, max(times) * 1.6)
    labels = LabelPlacement(lower)
    upper_labels = LabelPlacement(upper)
    draw_points(upper, rows, upper_labels, spare=1.0)
    _name_precisions(upper, rows)
    _name_rounded(upper_labels, rows)
    if doubles:
        zero = draw_points(lower, doubles, labels, spare=1.5)
        _name_points(labels, doubles, zero)
    label_ticks(lower.xaxis, math.log10(max(times) / min(times)))
    lower.set_xlabel('run time [ns per sample]')
    for axes in (upper, lower):
        axes.set_ylabel('largest relative error')
    _legend(figure, rows)
    upper_labels.place()
    labels.place()
    save(figure, path)
