"""Plots of the estimator's page."""
import statistics

from plot_style import FAINT, INK, SERIES_COLORS, SERIES_MARKERS, new_figure, save
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter, NullLocator

import estimator_data as ed
import estimator_text as text

SHORT_NAMES = {
    ed.DEFAULT: 'the estimator',
    'local_polynomial': 'local polynomials',
    'white_jerk': 'white jerk',
    'white_snap': 'white snap',
    'white_fifth': 'white fifth derivative',
    'spline': 'smoothing spline',
    'nine_samples': 'nine samples, order 3',
}


def _title(figure, words):
    figure.suptitle(words, x=0.01, ha='left', weight='bold', fontsize=12.5)


def _legend_below(figure, handles, columns):
    """A legend below all panels, which make room."""
    figure.canvas.draw()
    figure.set_constrained_layout(False)
    room = (0.25 * -(-len(handles) // columns) + 0.15) / figure.get_figheight()
    for axes in figure.axes:
        box = axes.get_position()
        axes.set_position([box.x0, room + box.y0 * (1 - room), box.width, box.height * (1 - room)])
    figure.legend(handles=handles, loc='lower center', ncol=columns)


def _plain(axis, values=None):
    if values:
        axis.set_major_locator(FixedLocator(values))
        axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: '%g' % value))
    axis.set_minor_formatter(NullFormatter())


def ratios(figures, path):
    """Error over that of the best filter, a dot for each stream, a row for each method."""
    methods = (ed.DEFAULT,) + ed.CONTENDERS
    figure, grid = new_figure((11.0, 5.8), 1, 2, sharey=True, sharex=True)
    for axes, groups, name in ((grid[0], (ed.GRID,), 'grid'),
                               (grid[1], ed.HARD, 'streams that fool simple answers')):
        for y, method in enumerate(methods):
            values = list(figures.offline_ratios(method, groups).values())
            spread = [y + 0.5 * ((0.618 * i) % 1 - 0.5) for i in range(len(values))]
            axes.plot(values, spread, linestyle='', marker='o', markersize=4, alpha=0.55,
                      color=SERIES_COLORS[0 if method == ed.DEFAULT else 1],
                      markeredgewidth=0)
            middle = statistics.median(values)
            axes.plot([middle, middle], [y - 0.36, y + 0.36], color=INK, linewidth=2.2)
        axes.axvline(1, color=FAINT, linestyle='--', linewidth=1.2)
        axes.set_xscale('log')
        axes.set_title('%s (%d streams)' % (name, len(values)), fontsize=10.5)
        axes.set_xlabel('effort error over that of the best Savitzky–Golay filter')
        _plain(axes.xaxis, [0.5, 1, 2, 5, 10, 100, 1000])
    grid[0].set_yticks(range(len(methods)))
    grid[0].set_yticklabels([SHORT_NAMES[method] for method in methods])
    grid[0].invert_yaxis()
    _title(figure, 'Offline: error relative to a filter chosen with hindsight '
                   '(bar: median; dashed: as good)')
    save(figure, path)


def lags(figures, path):
    """Error over lag: a row for each rate, a column for each quantum."""
    streams = figures.streams('node', (ed.GRID,))
    rates = sorted({s.rate for s in streams})
    quanta = sorted({s.quantum for s in streams})
    figure, grid = new_figure((11.0, 2.2 + 2.2 * len(rates)), len(rates), len(quanta), sharex=True,
                              sharey=True, squeeze=False)
    kinds = [(velocities, jitter) for velocities in ('none', 'good')
             for jitter in sorted({s.jitter for s in streams})]
    times = figures.lags()
    for line, rate in zip(grid, rates):
        for axes, quantum in zip(line, quanta):
            for (velocities, jitter), color, marker in zip(kinds, SERIES_COLORS, SERIES_MARKERS):
                stream = ed.Stream(ed.GRID, rate, quantum, velocities, jitter)
                if stream not in streams:
                    continue
                for method, style in ((ed.DEFAULT, '-'), (ed.HINDSIGHT, ':')):
                    axes.plot(times, [100 * figures.value('node', stream, method, 'error', lag)
                                      for lag in times], color=color, linestyle=style,
                              marker=marker if style == '-' else '', markersize=4.5)
            axes.set_title('%d Hz, quantum %g rad' % (rate, quantum), fontsize=10)
            axes.set_yscale('log')
            _plain(axes.yaxis, [0.5, 1, 2, 5, 10, 20, 50, 100])
            _plain(axes.xaxis, times)
    for axes in grid[-1]:
        axes.set_xlabel('lag, ms')
    for axes in grid[:, 0]:
        axes.set_ylabel('effort error, %')
    handles = [Line2D([], [], color=color, marker=marker, markersize=5,
                      label=('with velocities' if velocities == 'good' else 'positions only')
                      + (', stamps err by %g ms' % jitter if jitter else ''))
               for (velocities, jitter), color, marker in zip(kinds, SERIES_COLORS,
                                                              SERIES_MARKERS)]
    handles.append(Line2D([], [], color=INK, linestyle=':', label='best smoother with hindsight'))
    _title(figure, 'Node: what lag buys (rms error of the worst joint over its rms effort)')
    _legend_below(figure, handles, 3)
    save(figure, path)


def calibration(figures, path):
    """Share of errors within two deviations, streams in order."""
    figure, grid = new_figure((11.0, 4.4), 1, 2, sharey=True)
    for axes, method, name in ((grid[0], ed.DEFAULT, 'offline'),
                               (grid[1], ed.NODE, 'node, lag %g ms' % ed.NODE_LAG)):
        axes.axhspan(100 * ed.WITHIN[0], 100 * ed.WITHIN[1], color='0.9')
        for quantity, color, marker in zip(('acceleration', 'effort'), SERIES_COLORS,
                                           SERIES_MARKERS):
            shares = sorted(figures.calibration(method, quantity).values())
            if not shares:
                continue
            axes.plot([100.0 * (i + 0.5) / len(shares) for i in range(len(shares))],
                      [100 * share for share in shares], color=color, marker=marker, markersize=4,
                      label='%s' % quantity)
        axes.axhline(95.45, color=FAINT, linestyle='--', linewidth=1.2)
        axes.set_title(name, fontsize=10.5)
        axes.set_xlabel('streams, the least calibrated first, %')
        axes.legend(loc='lower right')
    grid[0].set_ylabel('errors within two deviations, %')
    _title(figure, 'Calibration of the deviations (grey: 90 to 99 %; dashed: what a normal '
                   'distribution has)')
    save(figure, path)


def recording(figures, path):
    """Share of the measured torques' variance that is explained after the first second."""
    rows = [(name, late) for name, _, late in text.recording_rows(figures)]
    if not rows:
        return
    least = 0.8
    figure, axes = new_figure((9.0, 1.2 + 0.36 * len(rows)))
    for y, (name, value) in enumerate(rows):
        own = name.startswith(('defaults', 'node'))
        axes.plot(max(value, least), y, marker='o' if own else 'D', markersize=8,
                  color=SERIES_COLORS[0 if own else 1])
        axes.annotate(text.explained(value), (max(value, least), y), xytext=(9, 0),
                      textcoords='offset points', va='center', fontsize=9.5)
    values = [max(value, least) for _, value in rows]
    margin = max(0.005, 0.15 * (max(values) - min(values)))
    axes.set_xlim(min(values) - margin, max(values) + 2 * margin)
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([name for name, _ in rows])
    axes.invert_yaxis()
    axes.set_xlabel('explained share of the variance, after the first second')
    _title(figure, 'Measured torques of a real arm (diamonds: chosen with hindsight)')
    save(figure, path)
