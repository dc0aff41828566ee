"""The scene and the description that are read, and those that are written with what was found."""
import re
import xml.etree.ElementTree as xml

import numpy as np

from . import bodies
from .refusal import Refusal, in_quotes

MOVING = ('revolute', 'continuous', 'prismatic')


def _yaml():
    import yaml  # checked for at the start of the program

    class Loader(yaml.SafeLoader):
        """Takes no other words for true and false than the offline tool: a joint may be called on."""

    Loader.yaml_implicit_resolvers = {
        first: [(tag, pattern) for tag, pattern in resolvers if tag != 'tag:yaml.org,2002:bool']
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()}
    Loader.add_implicit_resolver('tag:yaml.org,2002:bool', re.compile('^(?:true|false)$'), list('tf'))
    return yaml, Loader


def read_scene(path):
    """The keys of a scene file; the offline tool says whether they are right."""
    if not path:
        return {}
    yaml, loader = _yaml()
    try:
        with open(path, encoding='utf-8') as file:
            scene = yaml.load(file, Loader=loader)
    except OSError as problem:
        raise Refusal('%s: %s' % (path, problem.strerror or problem)) from None
    except (yaml.YAMLError, UnicodeDecodeError) as problem:
        raise Refusal('%s: is not valid YAML: %s' % (path, ' '.join(str(problem).split()))) from None
    if scene is None:
        return {}
    if not isinstance(scene, dict):
        raise Refusal('%s: is not a map of keys' % path)
    for key in ('joints', 'payload'):
        entries = scene.get(key) or []
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise Refusal('%s: %s: is not a list of maps' % (path, key))
    return scene


def write_scene(path, scene, comments):
    yaml, _ = _yaml()
    with open(path, 'w', encoding='utf-8') as file:
        for line in comments:
            file.write('# %s\n' % line if line else '#\n')
        yaml.safe_dump(scene, file, sort_keys=False, allow_unicode=True, default_flow_style=None, width=100)


def rounded(value, digits=7):
    """A number with as many digits as any measurement has."""
    return float('%.*g' % (digits, value))


class Description:
    """A robot description as far as it is needed here; the offline tool has read it already or will."""

    def __init__(self, path):
        self.path = path
        try:
            self.tree = xml.parse(path)
        except OSError as problem:
            raise Refusal('%s: %s' % (path, problem.strerror or problem)) from None
        except xml.ParseError as problem:
            raise Refusal('%s: is not valid XML: %s' % (path, problem)) from None
        self.root = self.tree.getroot()

    def moving_joints(self):
        return [joint.get('name') for joint in self.root.findall('joint') if joint.get('type') in MOVING]

    def size(self):
        """How far the origins of joints are apart, m: the longest way from a joint to the root."""
        ways = {}
        joints = {joint.find('child').get('link'): joint for joint in self.root.findall('joint')
                  if joint.find('child') is not None and joint.find('parent') is not None}

        def way(link, depth=0):
            if link not in joints or depth > len(joints):
                return 0.0
            if link not in ways:
                joint = joints[link]
                origin = joint.find('origin')
                xyz = origin.get('xyz', '0 0 0') if origin is not None else '0 0 0'
                ways[link] = way(joint.find('parent').get('link'), depth + 1) + float(
                    np.linalg.norm([float(x) for x in xyz.split()]))
            return ways[link]

        return max([way(link) for link in joints] + [0.1])

    def with_bodies(self, found, path):
        """Writes the description with other bodies: found has parameters by link. What fixed joints hold
        to such a link is part of its body and has no inertia of its own any more."""
        carried = {}
        for joint in self.root.findall('joint'):
            if joint.get('type') == 'fixed':
                carried.setdefault(joint.find('parent').get('link'), []).append(joint.find('child').get('link'))
        links = {link.get('name'): link for link in self.root.findall('link')}
        for name, parameters in found.items():
            self._set_inertial(links[name], parameters)
            held = list(carried.get(name, []))
            while held:
                link = held.pop()
                if link in found:  # a joint that the scene lets move
                    continue
                held += carried.get(link, [])
                for inertial in links[link].findall('inertial'):
                    links[link].remove(inertial)
        self.tree.write(path, encoding='utf-8', xml_declaration=True)

    @staticmethod
    def _set_inertial(link, parameters):
        for inertial in link.findall('inertial'):
            link.remove(inertial)
        mass, centre, inertia = bodies.described(parameters)
        inertial = xml.Element('inertial')
        xml.SubElement(inertial, 'origin', xyz=' '.join(repr(float(x)) for x in centre), rpy='0 0 0')
        xml.SubElement(inertial, 'mass', value=repr(float(mass)))
        xml.SubElement(inertial, 'inertia', {
            'i' + 'xyz'[i] + 'xyz'[j]: repr(float(inertia[i, j])) for i in range(3) for j in range(i, 3)})
        inertial.tail = '\n  '
        link.insert(0, inertial)


def scene_to_fit(scene, joints, coulomb_velocity, payload_link):
    """The scene in which efforts are computed for the fit: the payload that is sought is taken off, and
    every joint has a velocity of dry friction."""
    result = dict(scene)
    entries = [dict(entry) for entry in scene.get('joints') or []]
    named = {entry.get('name'): entry for entry in entries}
    others = {entry.get('name') for entry in scene.get('joint_types') or [] if isinstance(entry, dict)}
    for name in joints:
        if name in others:
            continue
        if name not in named:
            named[name] = {'name': name}
            entries.append(named[name])
        named[name].setdefault('coulomb_velocity', coulomb_velocity)
    result['joints'] = entries
    if payload_link:
        result['payload'] = [entry for entry in scene.get('payload') or [] if entry.get('link') != payload_link]
    return result


def unloaded(scene):
    """The scene without payloads."""
    result = dict(scene)
    result.pop('payload', None)
    return result


def found_scene(scene_fitted, terms, payload):
    """The scene with what was found: terms are (joint, key, value), the payload an entry or none."""
    result = dict(scene_fitted)
    entries = {entry['name']: dict(entry) for entry in scene_fitted.get('joints') or []}
    for joint, key, value in terms:
        entries.setdefault(joint, {'name': joint})[key] = rounded(value)
    kept = []
    for entry in entries.values():
        if 'coulomb' not in entry:
            entry.pop('coulomb_velocity', None)
        if len(entry) > 1:
            kept.append(entry)
    result['joints'] = kept
    if payload is not None:
        result['payload'] = (result.get('payload') or []) + [payload]
    for key in ('joints', 'payload'):
        if not result.get(key):
            result.pop(key, None)
    return result


def payload_entry(link, parameters):
    mass, centre, inertia = bodies.described(parameters)
    six = inertia[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]
    # More digits than are known, so that rounding makes no inertia of it that no body can have.
    return {'link': link, 'mass': rounded(mass), 'at': [rounded(x) for x in centre],
            'inertia': [rounded(x, 12) for x in six]}


def check_link(link, description):
    names = [entry.get('name') for entry in description.root.findall('link')]
    if link not in names:
        raise Refusal('payload: the robot has no link %s; its links are %s'
                      % (in_quotes(link), ', '.join(in_quotes(name) for name in names)))
