"""Puts names beside the points of a plot so that neither names nor points cover each other."""
import math

# Directions in which a name may stand from its point; the first ones are the better ones.
DIRECTIONS = ((1, 0), (1, 1), (1, -1), (0, 1), (0, -1), (-1, 1), (-1, -1), (-1, 0))
DISTANCES = (9, 16, 26, 38, 52, 70, 92)  # points of type
LEADER_FROM = 20  # points of type: from here on a line leads from the name to its point
MARKER = 5  # points of type, half the size of a marker
GAP = 2


class _Box:
    def __init__(self, x0, y0, x1, y1):
        self.x0, self.y0, self.x1, self.y1 = x0, y0, x1, y1

    def overlap(self, other):
        width = min(self.x1, other.x1) - max(self.x0, other.x0)
        height = min(self.y1, other.y1) - max(self.y0, other.y0)
        return width * height if width > 0 and height > 0 else 0

    def outside(self, other):
        """How far it reaches out of the other."""
        return (max(0, other.x0 - self.x0) + max(0, self.x1 - other.x1)
                + max(0, other.y0 - self.y0) + max(0, self.y1 - other.y1))


def _beside(point, direction, distance, width, height, pixel):
    x, y = point
    dx, dy = direction
    reach = distance * pixel / math.hypot(dx, dy)
    x += dx * reach - (width if dx < 0 else width / 2 if dx == 0 else 0)
    y += dy * reach - (height if dy < 0 else height / 2 if dy == 0 else 0)
    return _Box(x, y, x + width, y + height)


def _covers(box, line):
    """Whether a straight line between two points passes through the box."""
    (x0, y0), (x1, y1) = line
    steps = 24
    return any(box.x0 < x0 + (x1 - x0) * i / steps < box.x1
               and box.y0 < y0 + (y1 - y0) * i / steps < box.y1 for i in range(steps + 1))


class LabelPlacement:
    """Names wanted in one axes; place() draws them once all points are drawn."""

    def __init__(self, axes, size=9):
        self._axes = axes
        self._size = size
        self._obstacles = []  # data coordinates of points that no name may cover
        self._names = []  # (data coordinates, text, colour)

    def avoid(self, x, y):
        self._obstacles.append((x, y))

    def want(self, x, y, text, color):
        self._names.append(((x, y), text, color))

    def place(self):
        """Draws the names; the axes must have their final limits."""
        figure = self._axes.figure
        figure.canvas.draw()  # lays the figure out
        figure.set_constrained_layout(False)
        renderer = figure.canvas.get_renderer()
        pixel = figure.dpi / 72.0
        frame = self._axes.get_window_extent(renderer)
        frame = _Box(frame.x0, frame.y0, frame.x1, frame.y1)
        points = [tuple(self._axes.transData.transform(p)) for p in self._obstacles]
        taken = [_Box(x - MARKER * pixel, y - MARKER * pixel, x + MARKER * pixel,
                      y + MARKER * pixel) for x, y in points]
        legend = self._axes.get_legend()
        if legend:
            extent = legend.get_window_extent(renderer)
            taken.append(_Box(extent.x0, extent.y0, extent.x1, extent.y1))
        leaders = []
        for where, text, color in sorted(self._names, key=lambda name: name[0]):
            point = tuple(self._axes.transData.transform(where))
            box, leader = self._best(point, text, frame, taken, leaders, renderer, pixel)
            taken.append(box)
            if leader:
                leaders.append(leader)
            self._draw(where, text, color, box, leader)

    def _best(self, point, text, frame, taken, leaders, renderer, pixel):
        probe = self._axes.text(0, 0, text, fontsize=self._size)
        extent = probe.get_window_extent(renderer)
        probe.remove()
        best = None
        for distance in DISTANCES:
            for rank, direction in enumerate(DIRECTIONS):
                box = _beside(point, direction, distance, extent.width + 2 * GAP,
                              extent.height + 2 * GAP, pixel)
                leader = None
                if distance > LEADER_FROM:
                    near = (min(max(point[0], box.x0), box.x1), min(max(point[1], box.y0), box.y1))
                    leader = (point, near)
                cost = (sum(box.overlap(other) for other in taken) + 50 * box.outside(frame)
                        + sum(1e3 for line in leaders if _covers(box, line))
                        + sum(1e3 for other in taken if leader and _covers(other, (
                            (point[0] + 0.3 * (leader[1][0] - point[0]),
                             point[1] + 0.3 * (leader[1][1] - point[1])), leader[1])))
                        + distance + rank)
                if best is None or cost < best[0]:
                    best = (cost, box, leader)
        return best[1:]

    def _draw(self, where, text, color, box, leader):
        back = self._axes.transData.inverted()
        x, y = back.transform(((box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2))
        if leader:
            end = back.transform(leader[1])
            self._axes.plot([where[0], end[0]], [where[1], end[1]], color=color, linewidth=0.8,
                            zorder=1.5)
        self._axes.text(x, y, text, fontsize=self._size, color=color, ha='center', va='center',
                        zorder=6)
