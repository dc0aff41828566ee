#!/usr/bin/python3
"""Compares a recorded run of the composed pendulum with its closed forms.

Usage: plot_composed_pendulum.py BAG FIGURE

BAG holds the paper's example as computed by two nodes: /inverse_dynamics from joint states and
/exact/inverse_dynamics from a joint trajectory, with the inputs of both. Draws Figures 3 to 6 of
the paper to FIGURE, and prints the largest errors and the run time per sample. Exits with 1 when a
sample is missing or an error is larger than it may be.
"""
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np
import rosbag

from composed_pendulum_closed_form import COLUMNS, closed_form, motion

DURATION = 6.0  # s, as in the paper
INPUTS, POINTS = 6001, 61  # what demo.launch publishes: 1 kHz, and 10 Hz in one trajectory
LAG = 0.05  # s, the estimator's default
FIGURES = ((3, 'm10_z'), (4, 'm21_z'), (5, 'f10_y'), (6, 'f21_x'))
NAMES = [name for name, _, _ in COLUMNS]


class Run:
    """The messages of one node in the bag."""

    def __init__(self, title, namespace, source, published, style, allowed, relative):
        self.title = title
        self.effort_topic = namespace + '/effort'
        self.reactions_topic = namespace + '/reactions'
        self.source = source
        self.published = published  # samples of the input
        self.diagnostics_name = namespace.lstrip('/') + ':'
        self.style = style
        self.allowed = allowed  # largest error
        self.relative = relative  # whether errors are parts of the column's range, not in its unit
        self.lag = LAG if relative else 0  # s that results end before the input
        self.inputs = []  # stamps, ns
        self.efforts = {}  # by stamp, ns
        self.forces = {}
        self.run_times = []  # (median, p99), us, one for each second of diagnostics

    def finish(self):
        """Times since the motion's start and results, one row for each column."""
        stamps = sorted(set(self.efforts) & set(self.forces))
        if not stamps or not self.inputs:
            raise SystemExit('No results of %s in the bag.' % self.effort_topic)
        # Stamps are integers, as in seconds since 1970 they would resolve 2e-7 s only.
        self.t = np.array([(stamp - self.inputs[0]) * 1e-9 for stamp in stamps])
        self.results = np.array([self.efforts[s] + self.forces[s] for s in stamps]).T
        self.exact = closed_form(self.t)
        self.errors = np.abs(self.results - self.exact)

    def missing(self):
        """The number of missing results, whether the recorder missed inputs or not."""
        expected = self.published - round(self.lag * (self.published - 1) / DURATION)
        return expected - min(len(self.efforts), len(self.forces))


def in_order(message_names, values, names):
    return [values[message_names.index(name)] for name in names]


def forces_of(message):
    wrenches = in_order(message.joint_names, message.wrench, ('joint_1', 'joint_2'))
    return [component for w in wrenches for component in (w.force.x, w.force.y)]


def input_stamps(message):
    start = message.header.stamp.to_nsec()
    if not hasattr(message, 'points'):
        return [start]
    return [start + point.time_from_start.to_nsec() for point in message.points]


def take_diagnostics(message, runs):
    for status in message.status:
        for run in runs:
            if not status.name.startswith(run.diagnostics_name):
                continue
            values = {value.key: value.value for value in status.values}
            try:
                run.run_times.append((float(values['run time per sample, median (us)']),
                                      float(values['run time per sample, p99 (us)'])))
            except KeyError:
                pass  # no result was computed yet


def read(bag_path, runs):
    with rosbag.Bag(bag_path) as bag:
        for topic, message, _ in bag.read_messages():
            if topic == '/diagnostics':
                take_diagnostics(message, runs)
            for run in runs:
                if topic == run.source:
                    run.inputs += input_stamps(message)
                elif topic == run.effort_topic:
                    run.efforts[message.header.stamp.to_nsec()] = in_order(
                        message.name, message.effort, ('joint_1', 'joint_2'))
                elif topic == run.reactions_topic:
                    run.forces[message.header.stamp.to_nsec()] = forces_of(message)
    for run in runs:
        run.finish()


def draw(runs, path):
    plt.rcParams.update({'font.size': 9, 'axes.titlesize': 10, 'axes.spines.top': False,
                         'axes.spines.right': False, 'axes.grid': True, 'grid.alpha': 0.3})
    figure = plt.figure(figsize=(12, 9))
    figure.suptitle('Composed pendulum: computed through ROS, and in closed form', fontsize=12)
    blocks = figure.add_gridspec(2, 2, left=0.07, right=0.985, bottom=0.06, top=0.915,
                                 hspace=0.3, wspace=0.2)
    dense = np.linspace(0, DURATION, 601)
    for block, (number, name) in zip(blocks, FIGURES):
        column = NAMES.index(name)
        _, unit, title = COLUMNS[column]
        upper, lower = block.subgridspec(2, 1, height_ratios=(2.2, 1), hspace=0.12).subplots(
            sharex=True)
        upper.plot(dense, closed_form(dense)[column], color='0.75', linewidth=6,
                   label='closed form')
        for run in runs:
            upper.plot(run.t, run.results[column], label=run.title, **run.style)
            # An error of zero has no place on a logarithmic axis.
            lower.semilogy(run.t, np.maximum(run.errors[column], 1e-17), **run.style)
        upper.set_title('Figure %d: %s' % (number, title))
        upper.set_ylabel('%s [%s]' % (name, unit))
        lower.set_ylabel('|error| [%s]' % unit)
        lower.set_xlabel('time [s]')
        lower.set_xlim(0, DURATION)
        lower.set_ylim(1e-17, 1e-2)
        lower.set_yticks([1e-16, 1e-12, 1e-8, 1e-4])
        if number == FIGURES[0][0]:
            upper.legend(loc='best', frameon=False)
    figure.savefig(path, dpi=110)


def report(runs):
    """Prints the tables; returns whether everything is as it should be."""
    good = True
    ranges = np.ptp(closed_form(np.linspace(0, DURATION, 6001)), axis=1)
    print('\nLargest errors against the closed forms, 0 to %g s' % DURATION)
    print('  %-8s %-6s %10s' % ('column', 'unit', 'range')
          + ''.join('  %30s' % run.title for run in runs))
    for i, (name, unit, _) in enumerate(COLUMNS):
        line = '  %-8s %-6s %10.4f' % (name, unit, ranges[i])
        for run in runs:
            worst = run.errors[i].max()
            share = worst / ranges[i]
            enough = (share if run.relative else worst) <= run.allowed
            good = good and enough
            line += '  %10.1e (%8.1e of range)%s' % (worst, share, ' ' if enough else '!')
        print(line)
    print('  allowed' + ' ' * 18 + ''.join(
        '  %30s' % ('%g%s' % (run.allowed, ' of range' if run.relative else '')) for run in runs))
    for run in runs:
        lost = run.missing()
        good = good and lost == 0 and abs(run.t[-1] + run.lag - DURATION) < 0.02
        print('  %s: %d inputs, %d results from %.3f to %.3f s, %d missing' % (
            run.title, run.published, len(run.t), run.t[0], run.t[-1], lost))
        if len(run.inputs) != run.published:
            print('    (the recorder took %d of the inputs)' % len(run.inputs))
    return good


def report_run_times(runs):
    print('\nRun time per sample, efforts and all reactions')
    for run in runs:
        if not run.run_times:
            print('  %-32s not in the bag' % run.title)
            continue
        median, p99 = np.array(run.run_times).T
        print('  %-32s median %.3f us, p99 %.3f us' % (run.title, np.median(median), p99.max()))


def main(arguments):
    if len(arguments) != 2 or arguments[0].startswith('-'):
        print(__doc__)
        return 2
    bag, figure = arguments
    runs = (
        Run('JointState at 1 kHz', '/inverse_dynamics', '/joint_states', INPUTS,
            {'color': 'tab:orange', 'linewidth': 1}, 1e-4, True),
        Run('JointTrajectory', '/exact/inverse_dynamics', '/exact/joint_trajectory', POINTS,
            {'color': 'tab:blue', 'linewidth': 0, 'marker': 'o', 'markersize': 3}, 1e-12, False),
    )
    read(bag, runs)
    draw(runs, figure)
    good = report(runs)
    report_run_times(runs)
    if not good:
        print('\nNot as it should be: an error is too large, or results are missing.')
    return 0 if good else 1


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
