"""Which way to compute is faster than which, from the measurements."""
import re
import statistics

from plot_style import method_name, mode_name
from report_data import ALL, EFFORTS, GENERATED, LAGRANGE, OWN, SINGLE, SINGLE_EFFORTS, Way

SAME = 0.05  # medians that differ by less are called equal
INSTRUCTION_SETS = ('baseline', 'avx2', 'avx512')
SET_NAMES = {'baseline': 'baseline', 'avx2': 'AVX2', 'avx512': 'AVX-512'}
LAYOUT_NAMES = {'soa': 'arrays', 'rows': 'rows'}


def way_name(way):
    """A way for readers: method, number type, mode, outputs, threads."""
    parts = [method_name(way.method), way.precision.replace('_', ' '), mode_name(way.mode),
             'efforts and all reactions' if way.outputs == ALL else 'efforts only']
    if way.threads > 1:
        parts.append('%d threads' % way.threads)
    return ', '.join(parts)


class Comparison:
    """How many times as fast one way is as another, scene by scene."""

    def __init__(self, data, name, way, other, meant_to_win=True):
        self.name = name
        self.way, self.other = way, other
        self.meant_to_win = meant_to_win
        self.ratios = {}
        for scene in data.scenes:
            a, b = data.find(scene, way), data.find(scene, other)
            if a and b:
                self.ratios[scene] = b.ns / a.ns

    def least(self):
        return min(self.ratios.values())

    def most(self):
        return max(self.ratios.values())

    def median(self):
        return statistics.median(self.ratios.values())

    def without_gain(self):
        """{scene: ratio} where it is not faster."""
        return {scene: ratio for scene, ratio in self.ratios.items() if ratio < 1 + SAME}


def _block(layout, instruction_set):
    return SINGLE._replace(mode='block_%s_%s' % (layout, instruction_set))


def _of_blocks(data, layouts):
    """Pairs of block ways, widest instructions last."""
    for layout in layouts:
        sets = [name for name in INSTRUCTION_SETS if _block(layout, name) in data.ways]
        for narrow, wide in zip(sets, sets[1:]):
            yield Comparison(data, 'blocks (%s): %s against %s' % (
                LAYOUT_NAMES[layout], SET_NAMES[wide], SET_NAMES[narrow]),
                _block(layout, wide), _block(layout, narrow))


def _of_layouts(data, layouts):
    for name in INSTRUCTION_SETS:
        if len(layouts) == 2:
            yield Comparison(data, 'blocks (%s): rows against arrays' % SET_NAMES[name],
                             _block('rows', name), _block('soa', name), meant_to_win=False)


def _of_own_ways(data):
    for way in data.ways:
        if way.method == OWN and way.threads > 1 and way._replace(threads=1) in data.ways and (
                way.precision, way.outputs) == ('double', ALL):
            yield Comparison(data, '%d threads against one (%s)' % (
                way.threads, mode_name(way.mode)), way, way._replace(threads=1))
    plain = [way for way in data.ways
             if way.method == OWN and way.threads == 1 and 'rows' not in way.mode]
    for way in plain:
        if (way.precision, way.outputs) == ('float', ALL):
            yield Comparison(data, 'float against double (%s)' % mode_name(way.mode), way,
                             way._replace(precision='double'))
    for way in plain:
        if (way.precision, way.outputs) == ('double', EFFORTS):
            yield Comparison(data, 'efforts only against all (%s)' % mode_name(way.mode), way,
                             way._replace(outputs=ALL))


def _of_generated(data):
    for way in data.ways:
        if way.method == GENERATED:
            yield Comparison(data, 'generated code against the library (%s, %s)' % (
                mode_name(way.mode), 'efforts' if way.outputs == EFFORTS else 'all'), way,
                             way._replace(method=OWN))


def own_comparisons(data):
    """What the package's own ways gain over one another; efforts and all reactions, double and one
    thread unless named otherwise."""
    layouts = [layout for layout in LAYOUT_NAMES
               if any(_block(layout, name) in data.ways for name in INSTRUCTION_SETS)]
    found = [Comparison(data, 'blocks (%s, %s) against one sample' % (
        LAYOUT_NAMES[layout], SET_NAMES[name]), _block(layout, name), SINGLE)
             for layout in layouts for name in INSTRUCTION_SETS]
    found += _of_blocks(data, layouts)
    found += _of_layouts(data, layouts)
    found += _of_own_ways(data)
    found += _of_generated(data)
    found.append(Comparison(data, 'long double against double (one sample)',
                            SINGLE._replace(precision='long_double'), SINGLE, meant_to_win=False))
    for precision in ('double', 'long_double'):
        ours = SINGLE._replace(precision=precision)
        found.append(Comparison(data, 'virtual work against Lagrange (one sample, %s)' %
                                precision.replace('_', ' '), ours,
                                ours._replace(method=LAGRANGE)))
    return [comparison for comparison in found if comparison.ratios]


def peer_comparisons(data):
    """One sample of ours against one of each peer, in double: like with like, and all of ours with
    efforts of theirs where a peer gives no reactions."""
    found = []
    for method in data.peers():
        efforts = Way(method, 'double', 'single', EFFORTS, 1)
        everything = efforts._replace(outputs=ALL)
        name = method_name(method)
        found.append(Comparison(data, '%s, efforts only both' % name, SINGLE_EFFORTS, efforts))
        found.append(Comparison(data, '%s, efforts and all reactions both' % name, SINGLE,
                                everything))
        if everything not in data.ways:
            found.append(Comparison(data, '%s gives efforts only, we all reactions too' % name,
                                    SINGLE, efforts))
    return [comparison for comparison in found if comparison.ratios]


def joint_costs(data, joints):
    """[(way, {chain length: ns per joint})] of the chains, for ways measured on two or more."""
    chains = {scene: joints[scene] for scene in data.scenes
              if scene in joints and re.fullmatch(r'chain_\d+', scene)}
    table = []
    for way in data.ways:
        costs = {n: data.find(scene, way).ns / n for scene, n in chains.items()
                 if data.find(scene, way)}
        if len(costs) > 1:
            table.append((way, costs))
    return table


def smaller_errors(data):
    """[(peer's way, {scene: (error of the peer, ours)})] where a peer errs less than one sample of
    ours with the same outputs, in double."""
    found = []
    for method in data.peers():
        for outputs in (EFFORTS, ALL):
            way = Way(method, 'double', 'single', outputs, 1)
            ours = SINGLE._replace(outputs=outputs)
            scenes = {}
            for scene in data.scenes:
                a, b = data.find(scene, way), data.find(scene, ours)
                if a and b and a.error < b.error:
                    scenes[scene] = (a.error, b.error)
            if scenes:
                found.append((way, scenes))
    return found


def worst_error(data, precision, scenes=None):
    """Of the package's own ways; None when there is none."""
    errors = [row.error for row in data.rows if row.way.method == OWN
              and row.way.precision == precision and (scenes is None or row.scene in scenes)]
    return max(errors) if errors else None
