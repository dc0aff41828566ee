"""The report: tables as text, CSV and Markdown, and plots where there is matplotlib."""
import csv
import os

import numpy as np

BAND = 2.5758  # of a normal distribution, for 99 %


def number(value, digits=5):
    return '-' if not np.isfinite(value) else '%.*g' % (digits, value)


def write_report(folder, outcome):
    rows = outcome.rows()
    write_csv(os.path.join(folder, 'parameters.csv'), rows)
    pictures = write_plots(folder, outcome)
    with open(os.path.join(folder, 'report.md'), 'w', encoding='utf-8') as file:
        file.write('\n'.join(markdown(outcome, rows, pictures)) + '\n')
    print('\n'.join(summary(outcome, rows, folder)))
    if not pictures:
        print('note: no plots, as matplotlib is missing (Debian, Ubuntu: python3-matplotlib)')


def write_csv(path, rows):
    with open(path, 'w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['parameter', 'of', 'unit', 'described', 'value', 'deviation', 'status'])
        for row in rows:
            writer.writerow([row.what, row.of, row.unit] +
                            ['' if not np.isfinite(x) else repr(float(x))
                             for x in (row.described, row.value, row.deviation)] + [row.status])


def cells_of(rows):
    return [[row.what + (' of ' + row.of if row.of else ''), row.unit, number(row.described),
             number(row.value), number(row.deviation, 2), row.status] for row in rows]


def judged_cells(judged):
    return [[name, number(size, 3), number(before, 4), number(after, 4), number(left, 3), number(right, 3)]
            for name, size, before, after, left, right in judged.rows]


PARAMETERS = ['parameter', 'unit', 'described', 'value', 'deviation', 'the motion']
JUDGED = ['joint', 'rms measured', 'VAF before', 'VAF after', 'rms left before', 'rms left after']


def shortened(text, most=48):
    return text if len(text) <= most else text[:most - 4] + ' ...'


def aligned(header, cells):
    widths = [max(len(line[i]) for line in [header] + cells) for i in range(len(header))]
    return ['  '.join(cell.ljust(width) if i in (0, len(header) - 1) else cell.rjust(width)
                      for i, (cell, width) in enumerate(zip(line, widths))).rstrip()
            for line in [header] + cells]


def table(header, cells):
    lines = ['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)]
    return lines + ['| ' + ' | '.join(cell.replace('|', '\\|') for cell in line) + ' |' for line in cells]


def facts(outcome):
    """Sentences about the fit."""
    white = outcome.whiteness()
    poor = [name for name, p in zip(outcome.names, white) if p < 0.01 / len(white)]
    lines = ['Fitted: %.4g s below %.3g Hz; residuals follow an autoregression of order %d.' % (
        outcome.span, outcome.cutoff, outcome.solution.colour.order)]
    if poor:
        lines.append('What is left after it is not white (Ljung-Box, 1 %%) for %s: deviations there are too '
                     'small.' % ', '.join(poor))
    else:
        lines.append('What is left after it is white (Ljung-Box, 1 %).')
    lines.append('Condition of the motion for what is excited: %.3g%s.' % (
        outcome.condition, '' if outcome.condition < 100 else '; above 100 a more exciting motion is worth while'))
    unseen = outcome.unseen()
    if unseen:
        lines.append('No motion of this robot shows %s.' % ', '.join(unseen))
    return lines


def worse_for(outcome):
    """Joints whose efforts fit worse than before, in rows that were not fitted."""
    return ['warning: efforts of %s fit worse than before in rows that were not fitted (rms left %.3g, %.3g '
            'before)' % (name, after, before) for judged in outcome.judged if judged.label == 'not fitted'
            for name, _, _, _, before, after in judged.rows if after > before]


def summary(outcome, rows, folder):
    lines = aligned(PARAMETERS, [[shortened(line[0])] + line[1:] for line in cells_of(rows)]) + ['']
    for judged in outcome.judged:
        lines += ['rows that were %s:' % judged.label] + aligned(JUDGED, judged_cells(judged))
        lines += ['mean VAF: %.4g before, %.4g after' % tuple(
            np.nanmean([row[i] for row in judged.rows]) for i in (2, 3)), '']
    return lines + facts(outcome) + worse_for(outcome) + ['Written: ' + os.path.join(folder, 'report.md')]


def markdown(outcome, rows, pictures):
    lines = ['# Identification', '', 'Robot `%s`, recording `%s`, fitted: %s.' % (
        outcome.arguments.urdf, ' '.join(outcome.arguments.motion), outcome.arguments.fit), '']
    lines += facts(outcome) + worse_for(outcome) + ['', '## Parameters', '']
    lines += table(PARAMETERS, cells_of(rows)) + ['']
    silent = [row for row in rows if not row.excited]
    if silent:
        lines += ['Not excited by this motion, and as described: %s.' % ', '.join(
            row.what + (' of ' + row.of if row.of else '') for row in silent), '']
    for judged in outcome.judged:
        lines += ['## Efforts in rows that were %s' % judged.label, ''] + table(JUDGED, judged_cells(judged)) + ['']
    lines += ['![%s](%s)\n' % (name.split('.')[0], name) for name in pictures]
    lines += ['Files: `scene.yaml`, which the node and the offline tool read%s; `parameters.csv`.' % (
        ', with `robot.urdf`' if outcome.urdf != outcome.arguments.urdf else '')]
    return lines


# --- plots


def write_plots(folder, outcome):
    try:
        import matplotlib
        matplotlib.use('Agg')
        import matplotlib.pyplot as plt
    except ImportError:
        return []
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False,
                         'axes.grid': True, 'grid.alpha': 0.3})
    draw_efforts(plt, os.path.join(folder, 'efforts.png'), outcome)
    draw_whiteness(plt, os.path.join(folder, 'whiteness.png'), outcome)
    return ['efforts.png', 'whiteness.png']


def draw_efforts(plt, path, outcome):
    """Measured and computed efforts and what is left, joint by joint; what was fitted is shaded."""
    before, measured, after, fitted = outcome.shown
    every = max(1, len(before.times) // 4000)
    times = before.times[::every] - before.times[0]
    before_efforts, after_efforts = outcome.before(before), outcome.after(after)
    count = len(outcome.efforts)
    figure, axes = plt.subplots(count, 2, figsize=(11, 1.7 * count + 0.8), sharex=True, squeeze=False,
                                constrained_layout=True)
    for row, i in enumerate(outcome.efforts):
        left, right = axes[row]
        left.plot(times, measured[::every, i], color='0.6', lw=1.6, label='measured')
        left.plot(times, before_efforts[::every, i], color='tab:orange', lw=1, label='computed before')
        left.plot(times, after_efforts[::every, i], color='tab:blue', lw=1, label='computed after')
        right.plot(times, (before_efforts - measured)[::every, i], color='tab:orange', lw=0.8, label='before')
        right.plot(times, (after_efforts - measured)[::every, i], color='tab:blue', lw=0.8, label='after')
        unit = 'measured units' if outcome.has_gains else outcome.unit_of('offset', outcome.names[row])
        left.set_ylabel('%s\n%s' % (outcome.names[row], unit))
        if fitted.any():
            end = before.times[fitted][-1] - before.times[0]
            for axis in (left, right):
                axis.axvspan(0, end, color='0.92', lw=0, zorder=0)
    axes[0][0].set_title('effort (grey: fitted)' if fitted.any() else 'effort (nothing of it fitted)')
    axes[0][1].set_title('computed less measured')
    axes[0][0].legend(loc='best', fontsize=7)
    axes[0][1].legend(loc='best', fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel('time [s]')
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_whiteness(plt, path, outcome):
    """Autocorrelations of what is left, and of the white rows that the fit weighs."""
    left, white, rows = outcome.colours()
    figure, axes = plt.subplots(1, 2, figsize=(11, 3.6), sharey=True, constrained_layout=True)
    for axis, values, title in ((axes[0], left, 'what is left'), (axes[1], white, 'after the autoregression')):
        for i, name in enumerate(outcome.names):
            axis.plot(range(1, len(values)), values[1:, i], '.-', lw=0.8, label=name)
        axis.axhspan(-BAND / np.sqrt(rows), BAND / np.sqrt(rows), color='0.88', lw=0, zorder=0)
        axis.set_title('%s (band: 99 %% of white noise)' % title)
        axis.set_xlabel('lag [rows of the fit]')
        axis.set_xticks(range(0, len(values), 5))
    axes[0].set_ylabel('autocorrelation')
    axes[1].legend(fontsize=7, ncol=2, loc='upper right')
    figure.savefig(path, dpi=110)
    plt.close(figure)
