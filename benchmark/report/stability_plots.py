"""One picture for each scene of the stability suite: error over the bound, and relative error
beside KDL's, over what is varied; of closed loops, what is determined as well."""
import math

from matplotlib.ticker import MaxNLocator, NullLocator

from plot_style import (BLUE, BLACK, FAINT, GREEN, ORANGE, PURPLE, SKY, VERMILLION, new_figure,
                        readable, save)

SIZE = (11.0, 4.6)  # inches
LOOP_SIZE = (14.0, 4.8)
EPS = 2.0 ** -52
SHADE = '0.93'  # of values at which the rank drops
LOOK = {  # precision: name for readers, colour, marker
    'double': ('double', BLUE, 'o'),
    'float': ('float', ORANGE, 's'),
    'long_double': ('long double', GREEN, '^'),
}
LEAST_OVER_BOUND = 1e-9  # where smaller ones are drawn
LEAST_RELATIVE = 1e-21
MOST_RELATIVE = 1e3
LOG_FROM = 30  # largest over smallest value
TICK_SPACING = 0.11  # of the axis
BESIDE = 0.04  # of the axis, left of the first value and right of the last
SMALLEST = 5e-324
LEGEND = 0.09  # of the figure's height


class Places:
    """Where the values of a parameter stand on the axis: zero beside the smallest of a logarithmic
    one."""

    def __init__(self, values):
        positive = [value for value in values if value > 0]
        self.logarithmic = bool(positive) and max(positive) > LOG_FROM * min(positive)
        self.values = values
        decades = math.log10(max(positive) / min(positive)) if self.logarithmic else 0
        self.zero = min(positive) / 10 ** max(1, decades / 12) if self.logarithmic else 0

    def of(self, value):
        return self.zero if value == 0 else value

    def label(self, axes):
        if not self.logarithmic:
            axes.set_xticks(self.values)
            return
        axes.set_xscale('log')
        axes.xaxis.set_minor_locator(NullLocator())
        first, last = self.of(self.values[0]), self.of(self.values[-1])
        beside = 10 ** (BESIDE * (math.log10(last) - math.log10(first)))
        axes.set_xlim(max(first / beside, SMALLEST), last * beside)
        shown = self._apart()
        axes.set_xticks([self.of(value) for value in shown])
        axes.set_xticklabels([brief(value) for value in shown])

    def _apart(self):
        """Values whose names do not touch, the first and the last among them."""
        places = [math.log10(self.of(value)) for value in self.values]
        least = TICK_SPACING * (places[-1] - places[0])
        shown = [0]
        for i in range(1, len(places)):
            if places[i] - places[shown[-1]] >= least and places[-1] - places[i] >= least:
                shown.append(i)
        return [self.values[i] for i in shown + [len(places) - 1]]


def brief(value):
    """A number for an axis."""
    if value == 0:
        return '0'
    if 1e-3 < value < 1e4:
        return '{:g}'.format(value)
    digit, exponent = ('%.0e' % value).split('e')
    return '$%s10^{%d}$' % ('' if digit == '1' else r'%s\cdot ' % digit, int(exponent))


def _draw(axes, places, curve, floor, ceiling, **look):
    """Numbers beyond the axis stand on its edge; what is not finite, as a cross on the upper."""
    points = [(places.of(value), number) for value, number in zip(curve.values, curve.numbers)
              if number is not None]
    if not points:
        return
    xs = [x for x, _ in points]
    axes.plot(xs, [min(max(y, floor), ceiling) for _, y in points], clip_on=False, **look)
    beyond = [x for x, y in points if not math.isfinite(y)]
    if beyond:
        axes.plot(beyond, [ceiling] * len(beyond), 'X', color=VERMILLION, markersize=11,
                  clip_on=False)


def _over_bound(axes, scene, places, bound):
    numbers = [row.over_bound for row in scene.rows if math.isfinite(row.over_bound)]
    top = max(10, 3 * max(numbers, default=1))
    floor = max(LEAST_OVER_BOUND, min([1e-2] + [number for number in numbers if number > 0]) / 3)
    for precision in scene.precisions:
        name, color, marker = LOOK[precision]
        # Where loads of a singular position are not borne no error is known.
        curve = scene.curve(precision, lambda row: None if scene.loops and row.over_bound == 0
                            else row.over_bound)
        _draw(axes, places, curve, floor, top, color=color, marker=marker, label=name)
    axes.axhline(1, color=VERMILLION, linewidth=1.8)
    axes.text(1.01, 1.0, 'bound', transform=axes.get_yaxis_transform(), va='center',
              color=readable(VERMILLION), fontsize=9.5)
    axes.set_yscale('log')
    axes.set_ylim(floor, top)
    axes.set_ylabel('largest error over ' + bound)
    axes.set_title('Error over its bound')


def _relative(axes, scene, places):
    curves = [(scene.curve(p, lambda row: row.relative), LOOK[p]) for p in scene.precisions]
    kdl = scene.curve('double', lambda row: row.kdl)
    sensitivity = scene.curve('double', lambda row: row.sensitivity)
    shown = [n for curve in [c for c, _ in curves] + [kdl, sensitivity] for n in curve.numbers
             if n and math.isfinite(n)]
    floor = max(LEAST_RELATIVE, min(shown, default=1e-17) / 10)
    top = min(MOST_RELATIVE, max(shown, default=1) * 30)
    _draw(axes, places, sensitivity, floor, top, color=FAINT, linestyle=':', linewidth=2,
          label='inputs off by one unit of their last digit (double)')
    for curve, (name, color, marker) in curves:
        _draw(axes, places, curve, floor, top, color=color, marker=marker, label=name)
    _draw(axes, places, kdl, floor, top, color=BLACK, marker='x', linestyle='--',
          label='KDL, efforts only')
    axes.set_yscale('log')
    axes.set_ylim(floor, top)
    axes.set_ylabel('largest error over largest of its kind')
    axes.set_title('Relative error')


def plot_scene(scene, title, path):
    figure, (left, right) = new_figure(SIZE, columns=2)
    figure.suptitle(title, x=0.01, ha='left', fontweight='bold', fontsize=13)
    places = Places(scene.values)
    _over_bound(left, scene, places, '4 L eps S')
    _relative(right, scene, places)
    for axes in (left, right):
        places.label(axes)
        axes.set_xlabel(scene.parameter.replace('^2', '²'))
    handles, names = right.get_legend_handles_labels()
    order = sorted(range(len(names)), key=lambda i: names[i].startswith('inputs'))
    figure.legend([handles[i] for i in order], [names[i] for i in order], loc='lower center',
                  ncol=len(names))
    figure.get_layout_engine().set(rect=(0, LEGEND, 1, 1 - LEGEND), w_pad=0.08)
    save(figure, path)


def _loop_errors(axes, scene, places):
    relative = scene.curve('double', lambda row: row.relative or None)
    singular = {loop.value for loop in scene.loops if loop.free_motions}
    sensitivity = scene.curve(
        'double', lambda row: None if row.value in singular else row.sensitivity or None)
    condition = scene.loop_curve(lambda loop: None if loop.free_motions else loop.condition * EPS)
    shown = [n for curve in (relative, sensitivity, condition) for n in curve.numbers
             if n and math.isfinite(n)]
    floor, top = min(shown, default=1e-17) / 10, min(MOST_RELATIVE, max(shown, default=1) * 30)
    _draw(axes, places, relative, floor, top, color=BLUE, marker='o', label='error', zorder=3)
    _draw(axes, places, condition, floor, top, color=BLACK, linestyle='--',
          label='condition times eps')
    _draw(axes, places, sensitivity, floor, top, color=FAINT, linestyle=':', linewidth=2,
          label='motion off by one unit of its last digit')
    axes.set_yscale('log')
    axes.set_ylim(floor, top)
    axes.set_ylabel('largest error over largest of its kind')
    axes.set_title('Relative error')


def _loop_counts(axes, scene, places):
    curves = (('rank', lambda loop: loop.rank, SKY, 'o'),
              ('redundant constraints', lambda loop: loop.redundant_constraints, ORANGE, 's'),
              ('free motions', lambda loop: loop.free_motions, PURPLE, 'D'))
    most = max(count(loop) for loop in scene.loops for _, count, _, _ in curves)
    for name, count, color, marker in curves:
        _draw(axes, places, scene.loop_curve(count), 0, most, color=color, marker=marker,
              markersize=11 if name == 'rank' else 6, label=name)
    axes.set_ylim(0, 1.15 * most)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_ylabel('number')
    axes.set_title('What is determined')
    share = axes.twinx()
    _draw(share, places, scene.loop_curve(lambda loop: 100 * loop.open / loop.components), 0, 100,
          color=readable(GREEN), linestyle='--', marker='^', label='components not determined')
    share.set_ylim(0, 100)
    share.set_ylabel('components not determined [%]', color=readable(GREEN))
    share.grid(False)
    share.spines['right'].set_visible(True)
    return share


def _shade_singular(axes, scene, places):
    """Where a free motion is found: from the values on, half-way to the next."""
    singular = [loop.value for loop in scene.loops if loop.free_motions]
    if not singular:
        return
    ordinary = [loop.value for loop in scene.loops if not loop.free_motions]
    first, last = axes.get_xlim()
    edge = math.sqrt(places.of(max(singular)) * places.of(min(ordinary))) if ordinary else last
    axes.axvspan(first, edge, color=SHADE, zorder=0)
    axes.text(0.02, 0.97, 'rank drops', transform=axes.transAxes, va='top', color=FAINT,
              fontsize=9.5)


def plot_loops(scene, title, path):
    figure, panels = new_figure(LOOP_SIZE, columns=3)
    figure.suptitle(title, x=0.01, ha='left', fontweight='bold', fontsize=13)
    places = Places(scene.values)
    _over_bound(panels[0], scene, places, '4 (L + n) eps condition S')
    _loop_errors(panels[1], scene, places)
    share = _loop_counts(panels[2], scene, places)
    for axes in panels:
        places.label(axes)
        axes.set_xlabel(scene.parameter)
        _shade_singular(axes, scene, places)
    handles, names = [], []
    for axes in (panels[1], panels[2], share):
        own_handles, own_names = axes.get_legend_handles_labels()
        handles += own_handles
        names += own_names
    figure.legend(handles, names, loc='lower center', ncol=len(names))
    figure.get_layout_engine().set(rect=(0, LEGEND, 1, 1 - LEGEND), w_pad=0.08)
    save(figure, path)
