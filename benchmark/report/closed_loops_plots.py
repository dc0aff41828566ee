"""Plots of mechanisms with closed loops: error over run time, and run time over number of loops."""
import math

from plot_style import (BLUE, FAINT, VERMILLION, label_ticks, method_color, mode_marker, new_figure,
                        save)
from label_placement import LabelPlacement
from matplotlib.lines import Line2D
from plot_work_precision import draw_points
from report_data import LAGRANGE, MOTION, OWN, SINGLE, SINGLE_EFFORTS

COMPLETION = SINGLE._replace(mode='completion', outputs=MOTION)
MAXIMAL = 'maximal_coordinates'
DENSE = 'dense'
PANELS = (12.5, 8.4)  # inches
ROWS_SIZE = (12.0, 5.8)
COLUMNS = 3
KINDS = (  # of points, in the legend: text, method, mode
    ('virtual work, motion of all joints given', OWN, 'single'),
    ('virtual work, passive joints completed first', OWN, 'completed'),
    ('one dense system of all bodies', MAXIMAL, 'single'),
    ("a user's dense code, efforts only", DENSE, 'single'),
    ('Lagrange with multipliers (long double)', LAGRANGE, 'single'),
)
SERIES = (  # of the rows: text, way, colour, marker, filled
    ('completion of passive joints', COMPLETION, VERMILLION, 'D', True),
    ('efforts and all reactions', SINGLE, BLUE, 'o', True),
    ('efforts only', SINGLE_EFFORTS, BLUE, 'o', False),
)


def in_us(row):
    return row._replace(ns=row.ns / 1e3)


def work_precision(data, scenes, titles, path):
    """A panel for each scene, all with the same axes."""
    lines = math.ceil(len(scenes) / COLUMNS)
    figure, grid = new_figure((PANELS[0], 0.9 + PANELS[1] / 2 * lines), rows=lines,
                              columns=COLUMNS, squeeze=False, sharex=True, sharey=True)
    figure.get_layout_engine().set(rect=(0.005, 0.08, 0.985, 0.91), hspace=0.06, wspace=0.04)
    panels = [axes for line in grid for axes in line]
    points = {scene: [in_us(row) for row in data.of_scene(scene) if row.way.outputs != MOTION]
              for scene in scenes}
    every = [row for rows in points.values() for row in rows]
    times = [row.ns for row in every]
    for axes, scene in zip(panels, scenes):
        axes.set_title(titles(scene))
        axes.set_xscale('log')
        axes.set_xlim(min(times) / 1.5, max(times) * 1.5)
        draw_points(axes, points[scene], LabelPlacement(axes), spare=1.0, limits_of=every)
        label_ticks(axes.xaxis, 4)
        axes.tick_params(labelbottom=True)
    for axes in panels[len(scenes):]:
        axes.set_visible(False)
    for axes in panels[max(0, len(scenes) - COLUMNS):len(scenes)]:
        axes.set_xlabel('run time [µs per sample]')
    for line in grid:
        line[0].set_ylabel('largest relative error')
    figure.suptitle('Closed loops: error over run time', x=0.01, ha='left', weight='bold',
                    fontsize=13)
    _name_kinds(figure)
    save(figure, path)


def _name_kinds(figure):
    plain = {'linestyle': '', 'markersize': 7.5, 'markeredgewidth': 1.5}
    entries = [Line2D([], [], marker=mode_marker(mode), color=method_color(method), label=text,
                      **plain) for text, method, mode in KINDS]
    entries += [Line2D([], [], marker='o', color=FAINT, label='efforts and all reactions', **plain),
                Line2D([], [], marker='o', color=FAINT, markerfacecolor='white',
                       label='efforts only (hollow)', **plain)]
    figure.legend(handles=entries, loc='lower center', ncol=3)


def over_loops(data, rows, path):
    """rows: [(title, [(number of loops, scene)])]; a panel for each, per loop."""
    figure, grid = new_figure(ROWS_SIZE, columns=len(rows), squeeze=False, sharey=True)
    figure.get_layout_engine().set(rect=(0.005, 0.1, 0.99, 0.88), wspace=0.04)
    for axes, (title, scenes) in zip(grid[0], rows):
        axes.set_title(title)
        axes.set_xscale('log')
        axes.set_yscale('log')
        for text, way, color, marker, filled in SERIES:
            found = [(n, data.find(scene, way)) for n, scene in scenes if data.find(scene, way)]
            axes.plot([n for n, _ in found], [row.ns / 1e3 / n for n, row in found], color=color,
                      marker=marker, markerfacecolor=color if filled else 'white',
                      markeredgewidth=1.4, linestyle='-' if filled else '--', label=text)
        axes.set_xlabel('number of loops')
        axes.set_xticks([n for n, _ in scenes])
        axes.set_xticklabels([str(n) for n, _ in scenes])
        axes.minorticks_off()
    low, high = grid[0][0].get_ylim()
    label_ticks(grid[0][0].yaxis, math.log10(high / low))
    grid[0][0].set_ylabel('run time [µs per sample and loop]')
    figure.suptitle('Run time per loop over the number of loops (level: in proportion to them)',
                    x=0.01, ha='left', weight='bold', fontsize=13)
    figure.legend(*grid[0][0].get_legend_handles_labels(), loc='lower center', ncol=len(SERIES))
    save(figure, path)
