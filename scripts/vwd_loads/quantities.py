"""The time series that loads are found of, for each joint and closure."""
import numpy as np

from vwd_loads import bearings
from vwd_loads.mechanism import COMPONENTS

TINY = 1e-12  # components of unit vectors that are rounding


class Quantity:
    """A series of one joint or closure."""

    def __init__(self, name, unit, values, words, components=None):
        self.name = name  # effort, force, fx, ...
        self.unit = unit
        self.values = values
        self.words = words  # for people
        self.components = components or {name}  # what it is made of: effort, fx, ...

    @property
    def signed(self):
        """Whether it has a sign, so that its cycles count."""
        return self.name not in ('force', 'moment', 'radial_force', 'tilting_moment')

    @property
    def loads_bearing(self):
        """Whether a bearing wears by it."""
        return self.name in ('force', 'radial_force', 'axial_force', 'tilting_moment')


class Part:
    """A joint, closure or ground with all of its series."""

    def __init__(self, name, reaction, effort):
        self.name = name
        self.reaction = reaction  # or None
        self.effort = effort  # or None
        self.quantities = []
        self.turning = None  # angular velocity about the axis, rad/s; None: does not turn, or not known
        self.position = None
        self.velocity = None  # of the effort's joint

    def quantity(self, name):
        return next((item for item in self.quantities if item.name == name), None)


def parts_of(table, mechanism):
    """All parts, in the order of the columns: those with reactions, then those with efforts only."""
    efforts = {effort.name: effort for effort in mechanism.efforts}
    parts = []
    for reaction in mechanism.reactions:
        part = Part(reaction.name, reaction, efforts.pop(reaction.name, None))
        _add_effort(part, table)
        _add_reaction(part, table)
        parts.append(part)
    for effort in efforts.values():
        part = Part(effort.name, None, effort)
        _add_effort(part, table)
        parts.append(part)
    return [part for part in parts if part.quantities]


def _add_effort(part, table):
    effort = part.effort
    if effort is None:
        return
    part.position = table.get('position.' + effort.motion)
    part.velocity = table.get('velocity.' + effort.motion)
    if effort.passive and not np.any(table.columns[effort.column]):
        return  # nothing drives it
    part.quantities.append(
        Quantity('effort', effort.effort_unit, table.columns[effort.column], 'effort'))


def _add_reaction(part, table):
    reaction = part.reaction
    wrench = np.column_stack([table.columns[reaction.column(c)] for c in COMPONENTS])
    forces, moments = wrench[:, :3], wrench[:, 3:]
    add = part.quantities.append
    add(Quantity('force', 'N', np.linalg.norm(forces, axis=1), 'force', set(COMPONENTS[:3])))
    add(Quantity('moment', 'N m', np.linalg.norm(moments, axis=1), 'moment', set(COMPONENTS[3:])))
    axis = reaction.axis
    if axis is not None:
        along, across = parts_of_axis(axis)
        add(Quantity('radial_force', 'N', bearings.across(forces, axis), 'radial force',
                     {COMPONENTS[i] for i in across}))
        add(Quantity('axial_force', 'N', bearings.along(forces, axis), 'axial force',
                     {COMPONENTS[i] for i in along}))
        add(Quantity('tilting_moment', 'N m', bearings.across(moments, axis), 'tilting moment',
                     {COMPONENTS[3 + i] for i in across}))
        add(Quantity('moment_about_axis', 'N m', bearings.along(moments, axis), 'moment about the axis',
                     {COMPONENTS[3 + i] for i in along}))
    for i, component in enumerate(COMPONENTS):
        add(Quantity(component, 'N' if i < 3 else 'N m', wrench[:, i].copy(), component))
    if reaction.turn:
        velocity = table.get(reaction.turn['velocity'])
        if velocity is not None:
            part.turning = reaction.turn.get('factor', 1.0) * velocity


def parts_of_axis(axis):
    """Which components, 0 to 2, are in what is along an axis, and in what is across it."""
    along = [i for i in range(3) if abs(axis[i]) > TINY]
    across = [i for i in range(3) if 1 - abs(axis[i]) > TINY]
    return along, across


def state_columns(table):
    """Names of the columns of the positions and velocities of joints."""
    return [name for name in table.columns if name.startswith(('position.', 'velocity.'))]
