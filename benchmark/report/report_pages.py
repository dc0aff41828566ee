"""The report's text, from the measurements."""
import comparisons
import markdown_text as md
from comparisons import way_name
from plot_style import method_name, mode_name
from report_data import (ALL, BASES, GENERATED, KNOWN_PEERS, LAGRANGE, OWN, PRECISIONS, SINGLE)

SHORT = 50  # moving joints: errors of robots up to this size are stated apart from longer chains
SCENES = {
    'pendulum': ('composed pendulum', "the paper's composed pendulum"),
    'six_axis_arm': ('six-axis arm', 'this repository\'s example arm'),
    'seven_axis_arm': ('seven-axis arm', 'an arm with seven turning joints'),
    'six_axis_arm_massless_tool': ('six-axis arm with massless tool',
                                   'the six-axis arm carrying moving links without mass'),
    'ur5': ('UR5', 'an industrial arm'),
    'tiago_no_hand': ('TIAGo', 'a wheeled robot with torso, head and arm'),
    'hyq': ('HyQ', 'a four-legged robot'),
}
WITH_FILES = ('ur5', 'hyq', 'tiago_no_hand')  # robots that are no part of the package
NO_LOSER = 'Nothing: every way that was meant to be faster was, in every scene.'


def scene_title(scene):
    if scene.startswith('chain_'):
        return 'chain of ' + scene[len('chain_'):]
    return SCENES[scene][0] if scene in SCENES else scene.replace('_', ' ')


def _scene_text(scene):
    if scene.startswith('chain_'):
        return 'a chain from a generator'
    return SCENES[scene][1] if scene in SCENES else ''


def scenes_table(data, joints):
    rows = []
    for scene in data.scenes:
        base = data.base(scene)
        rows.append([scene_title(scene), '`%s`' % scene, _scene_text(scene),
                     str(joints.get(scene, md.NONE)),
                     way_name(base.way) if base else 'no KDL solver was measured'])
    return md.table(['scene', 'in the files', 'what it is', 'moving joints', 'compared with'],
                    rows, left=3)


def _span(values, form):
    low, high = form(min(values)), form(max(values))
    return low if low == high else '%s to %s' % (low, high)


def _against_kdl(data, method):
    """Sentences on the package's times against one solver of KDL, where that is the base."""
    one, blocks = [], []
    for scene in data.scenes:
        base = data.base(scene)
        if not base or base.way.method != method:
            continue
        for row in data.of_scene(scene):
            if row.way == SINGLE:
                one.append(base.ns / row.ns)
            if row.way == SINGLE._replace(mode=row.way.mode) and row.way.mode != 'single':
                blocks.append((base.ns / row.ns, scene, row.way.mode))
    name = method_name(method)
    if one:
        yield ('One sample in double, efforts **and all reactions**: %s times as fast as %s, which '
               'gives efforts only (%d scenes).' % (_span(one, md.ratio), name, len(one)))
    if blocks:
        best, scene, mode = max(blocks)
        yield ('The fastest way on one core in double, all reactions written out: %s times as fast '
               'as %s (%s; %s).' % (md.ratio(best), name, scene_title(scene), mode_name(mode)))


def short_version(data, joints):
    """The results in a few sentences."""
    lines = [line for method in BASES for line in _against_kdl(data, method)]
    if not lines:
        lines.append('No solver of KDL was measured, so there is nothing to compare times with.')
    small = [scene for scene in data.scenes if joints.get(scene, SHORT + 1) <= SHORT]
    for precision in PRECISIONS:
        worst = comparisons.worst_error(data, precision, small)
        if worst is not None:
            lines.append('Largest error in %s: %s of the largest effort, force or moment up to %d '
                         'joints, %s in all scenes.' % (
                             precision.replace('_', ' '), md.error(worst), SHORT,
                             md.error(comparisons.worst_error(data, precision))))
    lost = [c for c in comparisons.peer_comparisons(data) if c.without_gain()]
    lines.append('Peers that were as fast or faster in some scene: %s.' % (
        md.listed(dict.fromkeys(method_name(c.other.method) for c in lost)) or 'none'))
    return _bullets(lines)


def _bullets(lines):
    return '\n'.join('- ' + line for line in lines) + '\n'


def not_measured(data):
    """Peers that are missing everywhere, and where the others are missing."""
    lines = []
    absent = [scene for scene in WITH_FILES if scene not in data.scenes]
    if absent:
        lines.append('Robots whose descriptions were not there: %s.' % (
            md.listed(scene_title(scene) for scene in absent)))
    missing = data.missing_peers()
    if missing:
        lines.append('Not found when the benchmark was built, and not in this report: %s.' % (
            md.listed(method_name(peer) for peer in missing)))
    for method in data.peers():
        if method not in KNOWN_PEERS:  # a variant, for some robots only
            continue
        scenes = [scene for scene in data.scenes
                  if not any(row.way.method == method for row in data.of_scene(scene))]
        if scenes:
            lines.append('%s was not measured on: %s.' % (
                method_name(method), md.listed(scene_title(scene) for scene in scenes)))
    without = [scene for scene in data.scenes if GENERATED in data.methods
               and not any(row.way.method == GENERATED for row in data.of_scene(scene))]
    if without:
        lines.append('Code was not generated where a robot has more than 100 moving joints, for '
                     'its source has 2 MB and more: %s.' % (
                         md.listed(scene_title(s) for s in without)))
    left_out = [scene for scene in data.scenes if LAGRANGE in data.methods
                and not any(row.way.method == LAGRANGE for row in data.of_scene(scene))]
    if left_out:
        lines.append('%s was left out where a robot has more than 100 moving joints, for its cost '
                     'grows with their square: %s.' % (
                         method_name(LAGRANGE), md.listed(scene_title(s) for s in left_out)))
    return _bullets(lines or ['Every peer was measured in every scene.'])


WAY_COLUMNS = ['method', 'mode', 'outputs']


def _way_cells(way):
    mode = mode_name(way.mode) + (', %d threads' % way.threads if way.threads > 1 else '')
    return [method_name(way.method), mode, 'all' if way.outputs == ALL else 'efforts']


def ratios_table(data):
    """Times as fast as KDL, by way and scene: double, blocks with all reactions, and the peers."""
    ways = [way for way in data.ways if way.precision == 'double' and (
        way.method != OWN or way.mode == 'single' or way.outputs == ALL)]
    bases = [data.base(scene) for scene in data.scenes]
    rows = [['**compared with**', '', ''] + [
        method_name(base.way.method) if base else md.NONE for base in bases],
            ['**its run time, ns**', '', ''] + [md.ns(base.ns if base else None) for base in bases]]
    for way in ways:
        row = _way_cells(way)
        for scene, base in zip(data.scenes, bases):
            found = data.find(scene, way)
            row.append(md.ratio(base.ns / found.ns) if base and found else md.NONE)
        rows.append(row)
    return md.table(WAY_COLUMNS + [scene_title(scene) for scene in data.scenes], rows, left=3)


def _comparison_rows(found):
    rows = []
    for c in found:
        least = min(c.ratios, key=c.ratios.get)
        no_gain = c.without_gain() if c.meant_to_win else {}
        rows.append([c.name, str(len(c.ratios)), '%s (%s)' % (
            md.ratio(c.least()), scene_title(least)), md.ratio(c.median()), md.ratio(c.most()),
            str(len(no_gain)) if c.meant_to_win else md.NONE])
    return rows


def comparisons_table(found):
    return md.table(['comparison', 'scenes', 'least', 'median', 'most', 'scenes without gain'],
                    _comparison_rows(found))


def _scene_ratios(ratios):
    return md.listed('%s (%.2f)' % (scene_title(scene), r) for scene, r in ratios.items())


def did_not_win(data):
    """What is not faster, or errs more, than what it was compared with."""
    lines = ['%s: no faster on %s.' % (c.name, _scene_ratios(c.without_gain()))
             for c in comparisons.peer_comparisons(data) + comparisons.own_comparisons(data)
             if c.meant_to_win and c.without_gain()]
    for way, scenes in comparisons.smaller_errors(data):
        lines.append('%s errs less than our one sample on %s.' % (
            way_name(way), md.listed('%s (%s; ours %s)' % (
                scene_title(scene), md.error(theirs), md.error(ours))
                for scene, (theirs, ours) in scenes.items())))
    return _bullets(lines or [NO_LOSER])


def errors_table(data):
    """Worst error by method, number type and scene, over modes, outputs and threads."""
    groups = dict.fromkeys((way.method, way.precision) for way in data.ways)
    rows = []
    for method, precision in groups:
        row = [method_name(method), precision.replace('_', ' ')]
        for scene in data.scenes:
            errors = [found.error for found in data.of_scene(scene)
                      if (found.way.method, found.way.precision) == (method, precision)]
            row.append(md.error(max(errors) if errors else None))
        rows.append(row)
    return md.table(['method', 'number type'] + [scene_title(s) for s in data.scenes], rows, left=2)


def joint_costs_table(data, joints):
    """ns per joint of the chains, and how they grow from 10 joints on."""
    costs = comparisons.joint_costs(data, joints)
    lengths = sorted({n for _, found in costs for n in found})
    rows = []
    for way, found in costs:
        if way.precision != 'double' or way.threads > 1:
            continue
        long = [cost for n, cost in found.items() if n >= 10]
        rows.append(_way_cells(way) + [md.ns(found.get(n)) for n in lengths]
                    + [md.ratio(max(long) / min(long)) if len(long) > 1 else md.NONE])
    return md.table(WAY_COLUMNS + ['%d joints' % n for n in lengths]
                    + ['largest / smallest from 10 joints up'], rows, left=3)


def leave_out_table(omissions, scene):
    rows = omissions.of_scene(scene)
    whole = next((row for row in rows if row.left_out == 'reactions of fixed joints'), rows[0])
    lines = []
    for row in rows:
        same = row.same_numbers if isinstance(row.same_numbers, str) else (
            'within ' + md.error(row.same_numbers))
        lines.append([row.left_out, same, '{:,}'.format(row.multiplications),
                      '{:,}'.format(row.additions), md.ns(row.ns),
                      '%.0f %%' % (100 * (row.multiplications + row.additions)
                                   / max(1, whole.multiplications + whole.additions)),
                      '%.0f %%' % (100 * row.ns / whole.ns)])
    return md.table(['left out', 'same numbers', 'multiplications', 'additions', 'ns',
                     'operations', 'run time'], lines, left=2)


def instructions_table(instructions, data):
    """Instructions and ns of a sample, by way and scene."""
    rows = []
    for way in instructions.ways:
        row = _way_cells(way)
        row.insert(1, way.precision.replace('_', ' '))
        for scene in instructions.scenes:
            count = instructions.counts.get((scene, way))
            timed = data.find(scene, way)
            row += [md.NONE if count is None else '{:,}'.format(count),
                    md.ns(timed.ns if timed else None)]
        rows.append(row)
    header = ['method', 'number type'] + WAY_COLUMNS[1:]
    for scene in instructions.scenes:
        header += [scene_title(scene) + ': instructions', 'ns']
    return md.table(header, rows, left=4)


def generated_sizes_table(sizes):
    rows = [[scene_title(scene), 'all' if outputs == ALL else 'efforts']
            + ['{:,}'.format(count) for count in counts] for scene, outputs, counts in sizes.rows]
    return md.table(['scene', 'outputs', 'multiplications', 'additions', 'sines and cosines',
                     'code', 'stack', 'block: code', 'stack', 'small: code', 'stack'], rows, left=2)


def spread(data):
    """How far the rounds of one measurement lie apart, over all measurements."""
    spreads = sorted((row.ns_max / row.ns_min - 1, row.scene, row.way) for row in data.rows)
    middle, (worst, scene, way) = spreads[len(spreads) // 2][0], spreads[-1]
    return ('The slowest round of a measurement took %.0f %% longer than the fastest in the median '
            'of all measurements, and %.0f %% longer in the worst (%s; %s).' % (
                100 * middle, 100 * worst, scene_title(scene), way_name(way)))


def full_table(data, scene):
    rows = []
    base = data.base(scene)
    for row in data.of_scene(scene):
        way = row.way
        rows.append([method_name(way.method), way.precision.replace('_', ' '), way.mode,
                     way.outputs, str(way.threads), md.ns(row.ns), md.ns(row.ns_min),
                     md.ns(row.ns_max), md.ratio(base.ns / row.ns if base else None),
                     md.error(row.error)])
    return md.table(['method', 'number type', 'mode', 'outputs', 'threads', 'ns', 'least ns',
                     'most ns', 'times as fast as KDL', 'largest error'], rows, left=4)
