"""Run time over the number of joints, for chains and robots."""
import math
import re

from plot_style import (FAINT, label_ticks, method_color, method_name, mode_marker, mode_name,
                        new_figure, readable, save)
from report_data import ALL, EFFORTS, OWN

SIZE = (13.5, 7.2)  # inches
NAME_DISTANCE = 13  # points of type between the names of neighbouring lines


def drawn_ways(data):
    """One thread, double, and all reactions where the method has them. Of the blocks only those in
    structures of arrays: rows run beside them and would hide them."""
    ways = [way for way in data.ways
            if way.precision == 'double' and way.threads == 1 and 'rows' not in way.mode]
    return [way for way in ways
            if way.outputs == ALL or way._replace(outputs=ALL) not in ways]


def is_chain(scene):
    return re.fullmatch(r'chain_\d+', scene) is not None


def _name(way):
    name = method_name(way.method)
    if way.method == OWN:
        name = '%s: %s' % (name, mode_name(way.mode))
    return name + (' (efforts only)' if way.outputs == EFFORTS else '')


def _points(data, way, joints, chains):
    found = [(joints[scene], data.find(scene, way).ns) for scene in data.scenes
             if scene in joints and is_chain(scene) == chains and data.find(scene, way)]
    return sorted(found)


def _spread(heights, distance):
    """Heights moved apart to the distance, in the same order."""
    order = sorted(range(len(heights)), key=lambda i: heights[i])
    moved = list(heights)
    for _ in range(200):
        for a, b in zip(order, order[1:]):
            short = distance - (moved[b] - moved[a])
            if short > 1e-9:
                moved[a] -= short / 2
                moved[b] += short / 2
    return moved


def _name_lines(figure, axes, ends):
    """Names at the right of the axes, each led to the end of its line."""
    figure.canvas.draw()
    figure.set_constrained_layout(False)
    pixel = figure.dpi / 72.0
    frame = axes.get_window_extent()
    heights = [axes.transData.transform(end)[1] / pixel for end, _, _ in ends]
    for (end, name, color), height in zip(ends, _spread(heights, NAME_DISTANCE)):
        y = (height * pixel - frame.y0) / frame.height
        axes.annotate(name, xy=end, xycoords='data', xytext=(1.04, y),
                      textcoords='axes fraction', ha='left', va='center', fontsize=9,
                      color=readable(color), annotation_clip=False,
                      arrowprops={'arrowstyle': '-', 'color': color, 'linewidth': 0.8,
                                  'shrinkA': 1, 'shrinkB': 5})


def _draw(axes, data, joints, per_joint):
    ends = []
    for way in drawn_ways(data):
        chains = _points(data, way, joints, True)
        robots = _points(data, way, joints, False)
        color = method_color(way.method)
        for points, line in ((chains, '-'), (robots, 'None')):
            if points:
                axes.plot([n for n, _ in points], [ns / n if per_joint else ns for n, ns in points],
                          linestyle=line, color=color, marker=mode_marker(way.mode), markersize=6.5,
                          markerfacecolor=color if points is chains else 'white',
                          markeredgewidth=1.4)
        points = chains or robots
        if points:
            n, ns = points[-1]
            ends.append(((n, ns / n if per_joint else ns), _name(way), color))
    return ends


def plot_joints(data, joints, path):
    """joints: number of joints by scene."""
    figure, (left, right) = new_figure(SIZE, columns=2)
    figure.get_layout_engine().set(rect=(0.01, 0.03, 0.99, 0.96), wspace=0.04)
    counts = [joints[scene] for scene in data.scenes if scene in joints]
    for axes, per_joint in ((left, False), (right, True)):
        axes.set_xscale('log')
        axes.set_yscale('log')
        axes.set_xlim(min(counts) / 1.3, max(counts) * 1.3)
        ends = _draw(axes, data, joints, per_joint)
        axes.set_xlabel('number of moving joints')
        label_ticks(axes.xaxis, 3)
        low, high = axes.get_ylim()
        label_ticks(axes.yaxis, math.log10(high / low))
    left.set_title('Run time over number of joints')
    left.set_ylabel('run time [ns per sample]')
    right.set_title('The same per joint')
    right.set_ylabel('run time [ns per sample and joint]')
    _name_lines(figure, right, ends)
    figure.text(0.01, 0.008, 'Lines: chains. Hollow: robots and arms. One thread, double; efforts '
                'and all reactions unless named efforts only.', fontsize=9, color=FAINT)
    save(figure, path)
