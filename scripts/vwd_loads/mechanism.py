"""What the columns of results belong to."""
import json
import math

import numpy as np

from vwd_loads.errors import ReportError

COMPONENTS = ('fx', 'fy', 'fz', 'tx', 'ty', 'tz')
FORMAT = 1


class Reaction:
    """A joint, closure or ground whose reaction wrench the results have."""

    def __init__(self, name, said):
        self.name = name
        self.kind = said.get('kind', 'joint')  # joint, closure or ground
        self.type = said.get('type', '')
        self.axis = _unit_vector(said.get('axis'))  # in axes of the wrench; None: not known, or none
        self.turn = said.get('turn')  # {'velocity': column, 'factor': number}: of its turning
        self.moment_elsewhere = bool(said.get('moment_elsewhere'))

    def column(self, component):
        return 'reaction.%s.%s' % (self.name, component)


class Effort:
    """What has an effort: a joint, a part of one, or a closure."""

    def __init__(self, name, said):
        self.name = name
        self.column = said.get('column', 'effort.' + name)
        self.unit = said.get('unit')  # of the position: rad, m, or None where it is not known
        self.passive = bool(said.get('passive'))
        self.motion = said.get('motion', name)  # position.<motion>, velocity.<motion>
        self.effort_limit = said.get('effort_limit')
        self.velocity_limit = said.get('velocity_limit')

    @property
    def effort_unit(self):
        return {'rad': 'N m', 'm': 'N'}.get(self.unit, 'N m or N')

    @property
    def velocity_unit(self):
        return {'rad': 'rad/s', 'm': 'm/s'}.get(self.unit, '1/s')


class Mechanism:
    """All that results belong to."""

    def __init__(self, said, reactions, efforts):
        self.robot = said.get('robot', '')
        self.sources = [(word, said[word]) for word in ('description', 'scene', 'motion') if said.get(word)]
        self.axes = said.get('axes', '')
        self.max_gap = said.get('max_gap', 0.25)
        self.known = bool(said)
        self.reactions = reactions
        self.efforts = efforts


def read_mechanism(path):
    """Reads the file that inverse_dynamics_offline --report writes. Raises ReportError, or OSError."""
    try:
        with open(path, encoding='utf-8') as file:
            said = json.load(file)
    except ValueError as error:
        raise ReportError('%s: cannot be read: %s' % (path, ' '.join(str(error).split())))
    if not isinstance(said, dict):
        raise ReportError('%s: is not a map of keys' % path)
    return said


def _items(table, said, key, named):
    """The list of maps of a key, each of which has the key `named`."""
    items = said.get(key, [])
    if not isinstance(items, list) or not all(isinstance(item, dict) and named in item for item in items):
        raise ReportError('%s: the mechanism\'s %s are not a list of maps with the key %s'
                          % (table.path, key, named))
    return items


def mechanism_of(table, said):
    """The mechanism of a table. `said`: what mechanism.json says, None: only what columns tell."""
    if said is None:
        said = {}
    if not isinstance(said, dict):
        raise ReportError('%s: the mechanism is not a map of keys' % table.path)
    if said and said.get('format') != FORMAT:
        raise ReportError('%s: the mechanism has the format %r, this program reads %r'
                          % (table.path, said.get('format'), FORMAT))
    axes_known = said.get('axes') == 'child'
    reactions, reactions_said = [], _items(table, said, 'reactions', 'name')
    for name in _reaction_names(table):
        of_name = next((item for item in reactions_said if item['name'] == name), {})
        if not axes_known:
            of_name = {key: value for key, value in of_name.items() if key != 'axis'}
        reactions.append(Reaction(name, of_name))
    described = {item['column']: item for item in _items(table, said, 'efforts', 'column')}
    efforts = []
    for column in table.columns:
        if column.startswith('effort.') or column in described:
            of_column = dict(described.get(column, {}), column=column)
            efforts.append(Effort(of_column.get('name', column[len('effort.'):]), of_column))
    if not reactions and not efforts:
        raise ReportError('%s: no column effort.<joint> or reaction.<joint>.fx' % table.path)
    return Mechanism(said, reactions, efforts)


def _reaction_names(table):
    names = []
    for column in table.columns:
        if not (column.startswith('reaction.') and column.endswith('.fx')):
            continue
        name = column[len('reaction.'):-len('.fx')]
        lacking = [c for c in COMPONENTS if table.get('reaction.%s.%s' % (name, c)) is None]
        if lacking:
            raise ReportError('%s: column reaction.%s.%s is missing' % (table.path, name, lacking[0]))
        names.append(name)
    return names


def _unit_vector(numbers):
    if numbers is None:
        return None
    vector = np.array(numbers, dtype=float)
    length = math.sqrt(float(vector @ vector))
    return vector / length if length > 0 else None
