#!/usr/bin/python3
"""Draws measured efforts beside computed ones, and what is missing between them.

Usage: plot_residuals.py OFFLINE_TOOL PICTURE OPTION ...

OFFLINE_TOOL is the executable inverse_dynamics_offline, which is run with the options: those that say where
robot, motion and measured efforts are, as --urdf, --motion, and --residuals or --measured. PICTURE (.png, .pdf,
.svg) shows, for each joint that was measured, both efforts and computed less measured, the external effort;
grey is two standard deviations of it where the options have --deviations. An option
--output FILE.csv keeps the table.
"""
import csv
import os
import subprocess
import sys
import tempfile

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np

from plot_closed_loops import STYLE

RESIDUAL = 'measured_residual.'
NO_TABLES = ('.npz', '.bag')  # what the tool writes by the end of a name
MOST = 4000  # points of a line


def output_of(options):
    """The file that the options say, or nothing."""
    for i, option in enumerate(options):
        if option.startswith('--output='):
            return option[len('--output='):]
        if option == '--output' and i + 1 < len(options):
            return options[i + 1]
    return None


def read(path):
    with open(path, encoding='utf-8') as file:
        rows = csv.reader(file)
        header = next(rows)
        values = np.array([[float(cell or 'nan') for cell in row] for row in rows])
    return {name: values[:, i] for i, name in enumerate(header)}


def thinned(count):
    """Rows of a line that a picture has room for; pieces stay what they are."""
    return slice(None, None, max(1, count // MOST))


def share_of_variance(measured, computed):
    known = np.isfinite(measured) & np.isfinite(computed)
    if np.count_nonzero(known) < 2 or np.var(measured[known]) == 0:
        return 'VAF -'
    return 'VAF %.3f' % (1 - np.var((measured - computed)[known]) / np.var(measured[known]))


def draw(table, path):
    joints = [name[len(RESIDUAL):] for name in table if name.startswith(RESIDUAL)]
    t = table['time']
    drawn = thinned(len(t))
    plt.rcParams.update(STYLE)
    figure, axes = plt.subplots(len(joints), 2, figsize=(12, 0.9 + 1.55 * len(joints)), sharex=True, squeeze=False)
    for joint, (left, right) in zip(joints, axes):
        measured, residual = table['measured_effort.' + joint], table[RESIDUAL + joint]
        computed = measured + residual
        left.plot(t[drawn], measured[drawn], color='tab:orange', linewidth=1, label='measured')
        left.plot(t[drawn], computed[drawn], color='tab:blue', linewidth=1, label='computed')
        left.set_ylabel(joint, rotation=0, ha='right', va='center')
        left.set_title(share_of_variance(measured, computed), loc='right', fontsize=8)
        deviation = table.get('deviation.' + RESIDUAL + joint)
        if deviation is not None:
            right.fill_between(t[drawn], -2 * deviation[drawn], 2 * deviation[drawn], color='0.85',
                               label='two deviations')
        right.plot(t[drawn], residual[drawn], color='tab:red', linewidth=0.8)
        right.axhline(0, color='0.4', linewidth=0.8)
        known = residual[np.isfinite(residual)]
        if known.size:
            right.set_title('rms %.3g, bias %.3g' % (np.sqrt(np.mean(known**2)), np.mean(known)), loc='right',
                            fontsize=8)
    axes[0, 0].legend(loc='lower left', bbox_to_anchor=(0, 1.0), ncol=2, frameon=False, borderaxespad=0.1)
    axes[0, 1].set_title('Computed less measured', loc='left')
    for side in axes[-1]:
        side.set_xlabel('time [s]')
    figure.text(0.01, 0.995, 'Efforts [N m, N]', va='top', fontsize=10)
    figure.tight_layout(rect=(0, 0, 1, 0.995))
    figure.savefig(path, dpi=100)
    plt.close(figure)


def main(words):
    if len(words) < 3 or words[0].startswith('-'):
        print(__doc__.strip(), file=sys.stderr)
        return 0 if words[:1] in (['-h'], ['--help']) else 2
    tool, picture, options = words[0], words[1], words[2:]
    kept = output_of(options)
    if kept is not None and kept.endswith(NO_TABLES):
        print('plot_residuals.py: --output %s: the picture is drawn from a CSV, so the file has to be one' % kept,
              file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        output = kept
        if output is None:
            output = os.path.join(folder, 'results.csv')
            options = options + ['--output', output]
        computed = subprocess.run([tool] + options, check=False)
        if computed.returncode != 0:
            return computed.returncode
        table = read(output)
    if not any(name.startswith(RESIDUAL) for name in table):
        print('plot_residuals.py: the options ask for no measured efforts: --residuals or --measured FILE',
              file=sys.stderr)
        return 2
    draw(table, picture)
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
