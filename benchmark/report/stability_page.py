#!/usr/bin/python3
"""Makes stability.md and its pictures from FOLDER/stability.csv and
FOLDER/stability_details.csv, which the program stability has written; scripts/stability.sh
calls it.
"""
import decimal
import math
import pathlib
import sys

import markdown_text as md
import stability_plots as plots
from page_program import progress, run
from stability_data import DOUBLE, PRECISIONS, Stability

CSV = 'stability.csv'
DETAILS_CSV = 'stability_details.csv'
PAGE = 'stability.md'
TEMPLATE = pathlib.Path(__file__).resolve().parent / 'stability_template.md'

TITLES = {  # scene in the CSV: for readers
    'mass_tip_to_base': 'Chain of seven: masses from base to tip',
    'mass_link_to_link': 'Chain of seven: masses from link to link',
    'length_tip_to_base': 'Chain of seven: lengths from base to tip',
    'length_link_to_link': 'Chain of seven: lengths from link to link',
    'needles': 'Needles',
    'discs': 'Discs',
    'point_masses': 'Small bodies and point masses',
    'massless': 'Massless links',
    'angles': 'Large angles',
    'geared_angles': 'Large angles of a joint that two others mimic',
    'rates': 'Fast motion',
    'accelerations': 'Large accelerations',
    'time_scales': 'Time scales',
    'tiny_masses': 'Masses near double’s smallest number',
    'tiny_rates': 'Rates near double’s smallest number, no gravity',
    'tiny_positions': 'Positions near double’s smallest number',
    'tiny_float_masses': 'Masses near float’s smallest number',
    'tiny_float_rates': 'Rates near float’s smallest number, no gravity',
    'tiny_float_positions': 'Positions near float’s smallest number',
    'signed_zeros': 'Zeros of either sign',
    'chains': 'Long chains',
    'stars': 'Stars',
    'binary_trees': 'Binary trees',
    'balance_counterweights': 'Balanced by counterweights: efforts are zero',
    'balance_hanging': 'Hanging links at rest: efforts are zero',
    'balance_vertical_axes': 'Axes along gravity, at rest: efforts are zero',
    'joint_stiffness': 'Stiff joints',
    'joint_damping': 'Damped joints',
    'loop_change_point': 'Parallelogram towards its change point',
    'loop_dead_centre': 'Slider-crank towards dead centre, slider driven',
    'loop_mass_ratio': 'Four-bar: mass of the coupler',
    'loop_unit_of_length': 'Four-bar: unit of length',
    'loop_tiny_link': 'Parallelogram with tiny coupler',
    'loop_stiff_joints': 'Four-bar with stiff and damped joints',
    'loop_rates': 'Fast four-bar',
    'loop_rod_on_an_arm': 'Arm held by a rod that points to its joint',
    'loop_rod_on_a_slide': 'Slide held by a rod across it',
    'loop_guide_along_a_slide': 'Slide held by a guide along it',
    'loop_plane_of_an_arm': 'Arm held by a plane across its axis',
    'loop_rod_on_a_mimic': 'Arm with a mimic joint, held by a rod',
    'loop_ball_on_an_axis': 'Arm held by a ball beside its axis',
    'loop_parallel_axes': 'Spherical four-bar whose axes become parallel',
    'loop_gimbals': 'Gimbals whose axes become parallel',
    'loop_ladder': 'Ladder of four-bars',
    'loop_small_wheels': 'Vehicle on two small wheels',
    'loop_far_centre': 'Steered vehicle whose centre of turning moves to infinity',
    'loop_toe_in': 'Wheels on one axle that become parallel',
    'loop_flat_triangle': 'Plate on three contacts that come to lie in a line',
    'loop_small_rack': 'Rack and small pinion',
    'loop_flat_screw': 'Screw whose pitch goes to zero',
}


def title_of(scene):
    return TITLES.get(scene.name, scene.name.replace('_', ' '))


def picture_of(scene):
    return 'stability_%s.png' % scene.name


def number(value):
    return md.NONE if value is None else 'infinite' if math.isinf(value) else md.error(value)


def times(ratio):
    """So many times a bound."""
    return md.NONE if ratio is None else 'not finite' if math.isinf(ratio) else '%.3g' % ratio


def over_bound(row):
    if row is None:
        return md.NONE
    text = times(row.over_bound)
    return text if row.over_bound <= 1 else '**%s**' % text


def certificate(scene):
    text = number(scene.largest_certificate())
    return text if scene.certified() else '**%s**' % text


def plain(value):
    """A value of a scene's parameter, in the fewest digits."""
    if value == 0 or 1e-3 <= value < 1e5:
        return '{:,g}'.format(value)
    return '{:e}'.format(decimal.Decimal(repr(value)).normalize()).replace('e+', 'e')


def place(scene, value):
    return '%s; %s: %s' % (title_of(scene), scene.parameter, plain(value))


def span(scene):
    return '%s … %s' % (plain(scene.values[0]), plain(scene.values[-1]))


def of_trees(what):
    """Of open chains, of which --scene may have left none."""
    def text(data):
        return what(data) if data.trees else ''
    return text


def table(data):
    if not data.trees:
        return 'No scene of open chains was computed in this run.\n'
    header = ['scene', 'from … to', 'worst error over the bound',
              'KDL’s over the bound (efforts, double)', 'over the narrower bound (double)',
              'worst certificate']
    rows = [['[%s](%s)' % (title_of(scene), picture_of(scene)), span(scene),
             over_bound(scene.worst()), times(scene.largest_kdl_over_bound()),
             times(scene.largest_over_subtree_bound()), certificate(scene)]
            for scene in data.trees]
    return md.table(header, rows, left=2)


def loop_table(data):
    if not data.closed_loops:
        return 'No scene of closed loops was computed in this run.\n'
    header = ['scene', 'from … to', 'worst error over the bound', 'worst relative error',
              'largest condition (full rank)', 'redundant constraints', 'singular at',
              'counts and flags not exact', 'completed', 'open after completion, over the limit']
    rows = []
    for scene in data.closed_loops:
        singular = [loop.value for loop in scene.loops if loop.free_motions]
        completed, states = (sum(getattr(loop, name) for loop in scene.loops)
                             for name in ('completed', 'states'))
        constraints = [loop.redundant_constraints for loop in scene.loops]
        rows.append(['[%s](%s)' % (title_of(scene), picture_of(scene)), span(scene),
                     over_bound(scene.worst()), number(scene.largest_relative(DOUBLE)),
                     number(scene.largest_condition()), counts(constraints),
                     'up to ' + plain(max(singular)) if singular else md.NONE,
                     bold(str(scene.apart()), scene.apart() > 0),
                     '{:,} of {:,}'.format(completed, states),
                     bold(times(scene.largest_residual()), (scene.largest_residual() or 0) > 1)])
    return md.table(header, rows, left=2)


def bold(text, wrong):
    return '**%s**' % text if wrong else text


def counts(numbers):
    low, high = min(numbers), max(numbers)
    return str(low) if low == high else '%d … %d' % (low, high)


@of_trees
def relative_table(data):
    header = ['scene', 'worst relative error, double', 'KDL’s, efforts only']
    rows = [[title_of(scene), number(scene.largest_relative(DOUBLE)), number(scene.largest_kdl())]
            for scene in data.trees]
    return md.table(header, rows)


@of_trees
def precision_table(data):
    header = ['scene'] + [word for p in PRECISIONS
                          for word in (plots.LOOK[p][0] + ': over the bound', 'relative')]
    rows = []
    for scene in data.trees:
        row = [title_of(scene)]
        for precision in PRECISIONS:
            row += [over_bound(scene.worst(precision)), number(scene.largest_relative(precision))]
        rows.append(row)
    return md.table(header, rows)


@of_trees
def verdict(data):
    worst = data.worst_of(data.trees)
    scene = data.scene(worst.scene)
    where = '%s; %s, `%s`' % (place(scene, worst.value), plots.LOOK[worst.precision][0],
                              worst.path)
    if data.stable(data.trees):
        return ('**All scenes are stable**: the worst error is %.3g of its bound (%s).'
                % (worst.over_bound, where))
    scenes = [scene for scene in data.trees if scene.worst().over_bound > 1]
    return ('**Not stable in all %d scenes**: errors beyond the bound in %s; the worst is %.3g '
            'times its bound (%s).' % (len(data.trees),
                                       md.listed('“%s”' % title_of(scene) for scene in scenes),
                                       worst.over_bound, where))


def loop_verdict(data):
    if not data.closed_loops:
        return ''
    worst = data.worst_of(data.closed_loops)
    scene = data.scene(worst.scene)
    wrong = [scene for scene in data.closed_loops
             if scene.worst().over_bound > 1 or not scene.right()]
    where = '%s of its bound (%s)' % (times(worst.over_bound), place(scene, worst.value))
    if not wrong:
        return ('**All scenes of closed loops are stable**: the worst error is %s, counts and '
                'flags are the exact ones, and completed motions close their loops.' % where)
    return ('**Not all scenes of closed loops are right**: errors, counts, flags or the completion '
            'are not in %s; the worst error is %s.'
            % (md.listed('“%s”' % title_of(scene) for scene in wrong), where))


@of_trees
def certificates_verdict(data):
    largest, worst = data.largest_certificate(), data.worst_certificate()
    where = place(data.scene(worst.scene), worst.value)
    if worst.over_limit <= 1:
        return ('All certificates are within their limits: the largest is %s (%s), the closest to '
                'its limit %.3g of it (%s).'
                % (number(largest.certificate), place(data.scene(largest.scene), largest.value),
                   worst.over_limit, where))
    return ('**Not all certificates are within their limits**: the worst, %s, is %.3g times its '
            'limit (%s).' % (number(worst.certificate), worst.over_limit, where))


@of_trees
def narrower_verdict(data):
    worst = data.worst_of_subtrees()
    beyond = [scene for scene in data.trees if scene.largest_over_subtree_bound() > 1]
    return ('Errors are beyond the narrower bound in %s of the %d scenes; the worst is '
            '%s times it (%s).'
            % (len(beyond) or 'none', len(data.trees), times(worst.over_subtree_bound),
               place(data.scene(worst.scene), worst.value)))


def float_left_out(data):
    lines = ['- %s: %s' % (title_of(scene), 'all' if len(values) == len(scene.values)
                           else md.listed(plain(value) for value in values))
             for scene in data.trees for values in [scene.left_out('float')] if values]
    return '\n'.join(lines) if lines else 'Nothing.'


def paths(data):
    return md.listed(
        '%s (%s)' % (plots.LOOK[p][0],
                     md.listed('`%s`' % path for precision, path in data.paths if precision == p))
        for p in PRECISIONS if any(precision == p for precision, _ in data.paths))


def page(data, quick):
    return TEMPLATE.read_text(encoding='utf-8').format(
        table=table(data), verdict=verdict(data), certificates=certificates_verdict(data),
        narrower=narrower_verdict(data), loop_table=loop_table(data),
        loops=loop_verdict(data), relative=relative_table(data), paths=paths(data),
        quick='This is a quick run (`--quick`): few states of each scene.\n\n' if quick else '',
        precisions=precision_table(data), left_out=float_left_out(data),
        rows='{:,}'.format(data.row_count),
        pictures='\n'.join('### %s\n\n%s' % (title_of(scene),
                                             md.image(title_of(scene), picture_of(scene)))
                           for scene in data.scenes))


def write(folder, quick):
    data = Stability(folder / CSV, folder / DETAILS_CSV)
    for old in folder.glob('stability_*.png'):
        old.unlink()
    for scene in data.scenes:
        progress('drawing ' + picture_of(scene))
        plot = plots.plot_loops if scene.loops else plots.plot_scene
        plot(scene, title_of(scene), folder / picture_of(scene))
    (folder / PAGE).write_text(page(data, quick), encoding='utf-8')
    progress(None)


def add_options(parser):
    parser.add_argument('--quick', action='store_true', help='say that the run was a quick one')


if __name__ == '__main__':
    sys.exit(run('stability_page.py', __doc__,
                 lambda arguments: write(arguments.folder, arguments.quick), add_options))
