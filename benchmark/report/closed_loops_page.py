#!/usr/bin/python3
"""Makes closed_loops.md and its plots from FOLDER/work_precision.csv and FOLDER/closed_loops.csv;
scripts/report.sh calls it.
"""
import math
import pathlib
import sys

import closed_loops_plots as plots
import markdown_text as md
from page_program import run
from plot_style import method_name, mode_name
from report_data import (CLOSED_LOOPS, LAGRANGE, OWN, SINGLE, SINGLE_EFFORTS, WORK_PRECISION,
                         ClosedLoops, WorkPrecision)

PAGE = 'closed_loops.md'
WORK_PRECISION_PLOT = 'closed_loops.png'
LOOPS_PLOT = 'closed_loops_rows.png'
TEMPLATE = pathlib.Path(__file__).resolve().parent / 'closed_loops_template.md'
TITLES = {
    'four_bar': 'planar four-bar',
    'slider_crank': 'slider-crank',
    'andrews_squeezer': "Andrews' squeezer",
    'planar_3rrr': 'planar 3-RRR',
    'stewart_gough': 'Stewart-Gough',
    'spatial_parallelogram': 'spatial parallelogram',
}
ROWS = (  # head of the scenes' names, title
    ('separate_four_bars', 'Four-bars side by side'),
    ('shared_rods', 'Neighbouring loops share a rod'),
)
COMPLETED = SINGLE._replace(mode='completed')
MAXIMAL = SINGLE._replace(method=plots.MAXIMAL)
LAGRANGE_WAY = SINGLE._replace(method=LAGRANGE, precision='long_double')


def title(scene):
    return TITLES.get(scene, scene.replace('_', ' '))


def us(row):
    return md.NONE if row is None else md.ns(row.ns / 1e3)


def own_error(data, scene):
    """The largest of the package's ways, or None."""
    errors = [row.error for row in data.of_scene(scene) if row.way.method == OWN]
    return max(errors) if errors else None


def _count_cells(counts):
    return [str(counts.coordinates), str(counts.loops), str(counts.conditions),
            str(counts.redundant_constraints)]


def _time_cells(data, scene):
    return [us(data.find(scene, way)) for way in (plots.COMPLETION, SINGLE_EFFORTS, SINGLE)] + [
        md.error(own_error(data, scene))]


TIME_COLUMNS = ['completion, µs', 'efforts only, µs', 'efforts and all reactions, µs',
                'largest error']


def examples_table(data, loops, scenes):
    rows = [[title(scene), '`%s`' % scene] + _count_cells(loops.counts[scene])
            + _time_cells(data, scene) for scene in scenes]
    return md.table(['mechanism', 'in the files', 'coordinates', 'loops', 'conditions',
                     'redundant constraints'] + TIME_COLUMNS, rows, left=2)


def ways_table(data, scenes):
    rows = []
    for scene in scenes:
        ours = data.find(scene, SINGLE)
        row = [title(scene)] + [us(data.find(scene, way)) for way in (
            SINGLE, COMPLETED, MAXIMAL, LAGRANGE_WAY)]
        for way in (MAXIMAL, LAGRANGE_WAY):
            other = data.find(scene, way)
            row.append(md.ratio(other.ns / ours.ns if ours and other else None))
        rows.append(row)
    return md.table(['mechanism', 'virtual work, µs', 'virtual work, completed first, µs',
                     'one system, µs', 'Lagrange, µs', 'one system / virtual work',
                     'Lagrange / virtual work'], rows)


def dense_table(data, scenes):
    rows = []
    for scene in scenes:
        row = [title(scene)]
        for way in (plots.COMPLETION, SINGLE_EFFORTS):
            ours = data.find(scene, way)
            other = data.find(scene, way._replace(method=plots.DENSE))
            row += [us(ours), us(other), md.ratio(other.ns / ours.ns if ours and other else None)]
        rows.append(row)
    return md.table(['mechanism', 'completion: virtual work, µs', 'dense code, µs', 'ratio',
                     'efforts: virtual work, µs', 'dense code, µs', 'ratio'], rows)


def rows_table(data, loops, name):
    scenes = loops.row(name)
    return md.table(['loops', 'coordinates', 'conditions', 'redundant constraints']
                    + TIME_COLUMNS + ['all, µs per loop'],
                    [[str(n)] + [_count_cells(loops.counts[scene])[i] for i in (0, 2, 3)]
                     + _time_cells(data, scene) + [_per_loop(data.find(scene, SINGLE), n)]
                     for n, scene in scenes])


def _per_loop(row, loops):
    return md.NONE if row is None else md.ns(row.ns / 1e3 / loops)


def growth(data, scenes, way):
    """(exponent of the run time's growth with the number of loops, from, to) between the longest
    row and that of a fifth of it or more; None when there are none."""
    found = [(n, data.find(scene, way)) for n, scene in scenes if data.find(scene, way)]
    if len(found) < 2:
        return None
    long, last = found[-1]
    short, first = next((n, row) for n, row in found if 5 * n >= long)
    if short == long:
        return None
    return math.log(last.ns / first.ns) / math.log(long / short), short, long


def growth_lines(data, loops):
    for name, text in ROWS:
        parts = []
        for what, way in (('completion', plots.COMPLETION), ('efforts only', SINGLE_EFFORTS),
                          ('efforts and all reactions', SINGLE)):
            found = growth(data, loops.row(name), way)
            if found:
                parts.append('%.2f (%s)' % (found[0], what))
                short, long = found[1:]
        if parts:
            yield ('%s, from %d to %d loops: run time grows with their number to the power of %s; '
                   '1 is in proportion.' % (text, short, long, md.listed(parts)))


def short_version(data, loops, scenes):
    lines = []
    for what, way in (('Given the motion of all joints', SINGLE),
                      ('Given that of the actuated joints only', COMPLETED)):
        times = [(data.find(scene, way).ns / 1e3, scene) for scene in scenes
                 if data.find(scene, way)]
        if times:
            (least, fast), (most, slow) = min(times), max(times)
            lines.append('%s, efforts, all reactions and what of them is determined take %s µs '
                         '(%s) to %s µs (%s).' % (what, md.ns(least), title(fast), md.ns(most),
                                                  title(slow)))
    ratios = [data.find(scene, MAXIMAL).ns / data.find(scene, SINGLE).ns for scene in scenes
              if data.find(scene, MAXIMAL) and data.find(scene, SINGLE)]
    if ratios:
        lines.append('One dense linear system of all bodies takes %s to %s times as long.' % (
            md.ratio(min(ratios)), md.ratio(max(ratios))))
    errors = [own_error(data, scene) for scene in scenes if own_error(data, scene) is not None]
    if errors:
        lines.append('Largest error of what is determined, in the examples: %s.' % (
            md.error(max(errors))))
    lines += growth_lines(data, loops)
    return '\n'.join('- ' + line for line in lines) + '\n'


def all_table(data, scene):
    rows = [[method_name(row.way.method), row.way.precision.replace('_', ' '),
             mode_name(row.way.mode), row.way.outputs, md.ns(row.ns), md.ns(row.ns_min),
             md.ns(row.ns_max), md.error(row.error)] for row in data.of_scene(scene)]
    return md.table(['method', 'number type', 'mode', 'outputs', 'ns', 'least ns', 'most ns',
                     'largest error'], rows, left=4)


def write(folder):
    loops = ClosedLoops(folder / CLOSED_LOOPS)
    data = WorkPrecision(folder / WORK_PRECISION).of_scenes(lambda scene: scene in loops.counts)
    scenes = [scene for scene in loops.examples() if scene in data.scenes]
    plots.work_precision(data, scenes, title, folder / WORK_PRECISION_PLOT)
    plots.over_loops(data, [(text, loops.row(name)) for name, text in ROWS], folder / LOOPS_PLOT)
    (folder / PAGE).write_text(TEMPLATE.read_text(encoding='utf-8').format(
        short=short_version(data, loops, scenes),
        examples=examples_table(data, loops, scenes),
        ways=ways_table(data, scenes),
        dense=dense_table(data, scenes),
        work_precision=md.image('Error over run time of six mechanisms', WORK_PRECISION_PLOT),
        rows_plot=md.image('Run time per loop over the number of loops', LOOPS_PLOT),
        rows='\n'.join('**%s**\n\n%s' % (text, rows_table(data, loops, name))
                       for name, text in ROWS),
        all='\n'.join(md.folded(title(scene), all_table(data, scene))
                      for scene in data.scenes)), encoding='utf-8')


if __name__ == '__main__':
    sys.exit(run('closed_loops_page.py', __doc__, lambda arguments: write(arguments.folder)))
