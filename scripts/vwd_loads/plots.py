"""Pictures of a load report, as SVG."""
import matplotlib
matplotlib.use('Agg')
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.colors import LogNorm  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402
import numpy as np  # noqa: E402

COLORS = {'effort': '#1d2733', 'fx': '#14596b', 'fy': '#c8553d', 'fz': '#e0a030', 'tx': '#14596b',
          'ty': '#c8553d', 'tz': '#e0a030'}
LIMIT = '#9b2226'
DOUBT = '#f4d6cf'
BUCKETS = 700  # points of a curve; more rows become bands from least to most
BINS = 60  # of the motor chart, each way

STYLE = {'font.size': 9, 'font.family': 'sans-serif', 'axes.spines.top': False, 'axes.spines.right': False,
         'axes.grid': True, 'grid.color': '#e3e7eb', 'grid.linewidth': 0.6, 'axes.edgecolor': '#5b6875',
         'axes.axisbelow': True, 'xtick.color': '#33415c', 'ytick.color': '#33415c', 'legend.frameon': False,
         'legend.fontsize': 8, 'axes.labelsize': 9, 'svg.hashsalt': 'loads', 'svg.fonttype': 'path',
         'path.simplify': True}


def _save(figure, path):
    figure.savefig(path, format='svg', metadata={'Date': None})  # equal results make equal pictures
    plt.close(figure)
    return path


def _axes(width, height, rows=1, columns=1, **more):
    with plt.rc_context(STYLE):
        return plt.subplots(rows, columns, figsize=(width, height), constrained_layout=True, **more)


def _curve(axes, times, values, pieces, color, label):
    """A curve with gaps where the pieces have them."""
    per_bucket = max(1, len(times) // BUCKETS)
    for piece in pieces:
        t, v = times[piece], values[piece]
        if per_bucket < 4 or len(t) < 4 * per_bucket:
            axes.plot(t, v, color=color, linewidth=0.9, label=label, marker='.' if len(t) == 1 else None)
        else:
            count = len(t) // per_bucket
            rows = np.array_split(np.arange(len(t)), count)
            middle = [t[r[0]] for r in rows] + [t[-1]]
            least = [v[r].min() for r in rows] + [v[-1]]
            most = [v[r].max() for r in rows] + [v[-1]]
            axes.fill_between(middle, least, most, color=color, linewidth=0.5, label=label)
        label = None


def _shade(axes, times, doubted):
    edges = np.flatnonzero(np.diff(np.concatenate(([0], doubted.astype(int), [0]))))
    least = (times[-1] - times[0]) / 500 if len(times) > 1 else 1.0
    for first, last in list(zip(edges[::2], edges[1::2] - 1))[:400]:
        axes.axvspan(times[first] - least, times[last] + least, color=DOUBT, linewidth=0, zorder=0)


def history_rows(loads, part):
    """What is drawn over time: names of quantities, forces above moments, the effort with its like."""
    forces = ['radial_force', 'axial_force'] if part.quantity('radial_force') else ['force']
    moments = ['tilting_moment'] if part.quantity('tilting_moment') else ['moment']
    effort = part.quantity('effort')
    (forces if effort and effort.unit == 'N' else moments).append('effort')
    rows = [[name for name in row if loads.matters(loads.get(part, name))] for row in (forces, moments)]
    return [row for row in rows if row]


def history(loads, part, doubted, path):
    """Forces above moments over time; `doubted`: rows by name of the quantity."""
    rows = history_rows(loads, part)
    times = loads.table.times
    with plt.rc_context(STYLE):
        figure, all_axes = _axes(9.2, 1.9 * len(rows) + 0.4, rows=len(rows), sharex=True, squeeze=False)
        for axes, names in zip(all_axes[:, 0], rows):
            _shade(axes, times, np.any([doubted[name] for name in names], axis=0))
            for name, color in zip(names, ('#14596b', '#c8553d', '#1d2733')):
                load = loads.get(part, name)
                _curve(axes, times, load.quantity.values, load.pieces, color, load.quantity.words)
                axes.set_ylabel(load.quantity.unit)
            axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0))
            axes.margins(x=0.01)
        all_axes[-1, 0].set_xlabel('time, s')
        return _save(figure, path)


def _limit_lines(axes, effort):
    if effort.effort_limit:
        for sign in (-1, 1):
            axes.axhline(sign * effort.effort_limit, color=LIMIT, linewidth=1.1, linestyle='--')
    if effort.velocity_limit:
        for sign in (-1, 1):
            axes.axvline(sign * effort.velocity_limit, color=LIMIT, linewidth=1.1, linestyle='--')


def motor_chart(part, path):
    """Effort against speed, as the number of rows, with the limits of the description."""
    effort, values, speeds = part.effort, part.quantity('effort').values, part.velocity
    exists = np.isfinite(values) & np.isfinite(speeds)
    with plt.rc_context(STYLE):
        figure, axes = _axes(4.6, 3.5)
        if np.sum(exists) > 3000:
            counts, x, y = np.histogram2d(speeds[exists], values[exists], bins=BINS)
            picture = axes.pcolormesh(x, y, np.ma.masked_equal(counts.T, 0), norm=LogNorm(), cmap='viridis_r',
                                      rasterized=True)
            figure.colorbar(picture, ax=axes, label='rows', pad=0.02)
        else:
            axes.plot(speeds[exists], values[exists], '.', markersize=2.5, color=COLORS['effort'])
        _limit_lines(axes, effort)
        axes.axhline(0, color='#5b6875', linewidth=0.6)
        axes.axvline(0, color='#5b6875', linewidth=0.6)
        axes.set_xlabel('speed, ' + effort.velocity_unit)
        axes.set_ylabel('effort, ' + effort.effort_unit)
        return _save(figure, path)


def spectra(spectra_of, path):
    """Densities of what is given as (words, unit, Spectrum), in one pair of axes for each unit."""
    units = sorted({unit for _, unit, _ in spectra_of})
    with plt.rc_context(STYLE):
        figure, all_axes = _axes(4.6, 3.5, rows=len(units), sharex=True, squeeze=False)
        for axes, unit in zip(all_axes[:, 0], units):
            drawn = [(words, spectrum) for words, own, spectrum in spectra_of if own == unit]
            for (words, spectrum), color in zip(drawn, ('#14596b', '#c8553d', '#e0a030')):
                axes.loglog(spectrum.frequencies, np.maximum(spectrum.density, 1e-300), color=color,
                            linewidth=0.9, label=words)
            most = max(float(np.max(spectrum.density)) for _, spectrum in drawn)
            if most > 0:
                axes.set_ylim(most * 1e-10, most * 5)
            axes.set_ylabel('%s²/Hz' % (unit if ' ' not in unit else '(%s)' % unit))
            axes.legend(loc='lower left')
        all_axes[-1, 0].set_xlabel('frequency, Hz')
        return _save(figure, path)


def cycles(loads_of, path):
    """For each load how many cycles have at least a range, in one pair of axes for each unit."""
    units = sorted({load.quantity.unit for load in loads_of})
    with plt.rc_context(STYLE):
        figure, all_axes = _axes(4.6, 3.5, rows=len(units), squeeze=False)
        for axes, unit in zip(all_axes[:, 0], units):
            for load in loads_of:
                if load.quantity.unit != unit or len(load.ranges) == 0:
                    continue
                order = np.argsort(load.ranges)[::-1]
                ranges, counted = load.ranges[order], np.cumsum(load.counts[order])
                keep = np.unique(np.geomspace(1, len(ranges), 400).astype(int) - 1)
                axes.step(counted[keep], ranges[keep], where='pre', color=COLORS[load.quantity.name],
                          linewidth=1.1, label=load.quantity.words)
            axes.set_xscale('log')
            if axes.get_xlim()[1] < 100 * axes.get_xlim()[0]:
                axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: '%g' % value))
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.set_ylim(bottom=0)
            axes.set_ylabel('range, ' + unit)
            axes.legend(loc='upper right')
        all_axes[-1, 0].set_xlabel('cycles of at least this range')
        return _save(figure, path)


def limits_used(rows, path):
    """Bars: (name, {words: part of the limit})."""
    words = []
    for _, parts in rows:
        words += [word for word in parts if word not in words]
    colors = {word: color for word, color in zip(words, ('#14596b', '#86b6c2', '#c8553d'))}
    with plt.rc_context(STYLE):
        figure, axes = _axes(9.2, 0.9 + 0.42 * len(rows))
        height = 0.8 / len(words)
        for i, (_, parts) in enumerate(rows):
            for k, word in enumerate(words):
                if word in parts:
                    axes.barh(i + (k - (len(words) - 1) / 2) * height, 100 * parts[word], 0.9 * height,
                              color=colors[word], label=word if word not in axes.get_legend_handles_labels()[1]
                              else None)
        axes.axvline(100, color=LIMIT, linewidth=1.1, linestyle='--')
        axes.set_yticks(range(len(rows)))
        axes.set_yticklabels([name for name, _ in rows])
        axes.invert_yaxis()
        axes.yaxis.grid(False)
        axes.set_xlabel('part of the limit in the description, %')
        axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0))
        return _save(figure, path)


def peaks_of_motions(peaks, unit, words, path):
    """The peaks of many motions in order, one curve for each joint: {name: values}."""
    with plt.rc_context(STYLE):
        figure, axes = _axes(9.2, 3.0)
        colors = plt.get_cmap('tab10')
        for i, (name, values) in enumerate(peaks.items()):
            ordered = np.sort(values)[::-1]
            axes.step(np.arange(1, len(ordered) + 1), ordered, where='mid', color=colors(i % 10),
                      linestyle='-' if i < 10 else '--', linewidth=1.1, label=name,
                      marker='.' if len(ordered) == 1 else None)
        axes.set_xlabel('motions, the largest peak of each joint first')
        axes.set_ylabel('peak of %s, %s' % (words, unit))
        axes.set_ylim(bottom=0)
        axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), ncol=1 if len(peaks) <= 12 else 2)
        return _save(figure, path)
