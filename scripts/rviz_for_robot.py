#!/usr/bin/python3
"""Shows a robot and its reaction wrenches in RViz.

Usage: rviz_for_robot.py [--scene SCENE.yaml] [--frame FRAME] [--template RVIZ] [--print] ROBOT.urdf
           [RVIZ_ARGUMENT ...]

Fills a template (the package's config/inverse_dynamics.rviz) with the robot's root link as fixed frame
and one arrow display for each reaction that the scene asks for, closures included (without a scene,
those of all movable joints), scaled by the robot's weight, and starts RViz with it. With --print the
configuration goes to standard output instead, as a start for one of your own.
"""
import argparse
import copy
import math
import os
import pathlib
import re
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import yaml

# Lengths over the robot's reach: an arrow of the robot's weight, or of the moment of its weight at an
# arm as long as the reach; the width of arrows; the height at which the camera looks, and its distance.
ARROW = 0.4
WIDTH = 0.045
FOCUS = 0.23
DISTANCE = 1.5
PIXELS = 420  # the reach in a view from above
GRAVITY = 9.81
TEMPLATE = pathlib.Path(__file__).resolve().parent.parent / 'config' / 'inverse_dynamics.rviz'
MOVABLE = ('revolute', 'continuous', 'prismatic')


def topic(reaction):
    """The node's topic of a reaction: illegal characters become an underscore."""
    name = re.sub('[^A-Za-z0-9_]', '_', reaction)
    return '/inverse_dynamics/reaction/' + ('_' + name if name[:1].isdigit() else name)


def reactions_of(robot, scene):
    """Names of the joints and closures that have a reaction topic."""
    wanted = scene.get('reactions', 'all')
    if isinstance(wanted, list):
        return wanted
    if wanted == 'none':
        return []
    return ([joint.get('name') for joint in robot.findall('joint') if joint.get('type') in MOVABLE] +
            [closure['name'] for closure in scene.get('closures') or []])


def length(numbers):
    return math.sqrt(sum(number * number for number in numbers))


def origin(element):
    """Distance of a joint's or an inertial's origin."""
    found = element.find('origin') if element is not None else None
    return 0 if found is None else length(float(n) for n in found.get('xyz', '0 0 0').split())


def reach(robot, scene):
    """How far from the root link the robot may extend, roughly; 1 where nothing tells it."""
    slides = {start['name']: abs(start['position']) for start in scene.get('assembly') or []}
    joints = {joint.find('child').get('link'): joint for joint in robot.findall('joint')}
    pins = [closure[side] for closure in scene.get('closures') or [] for side in ('parent', 'child')]
    ends = [(link.get('name'), origin(link.find('inertial'))) for link in robot.findall('link')]
    ends += [(pin['link'], length(pin.get('xyz') or [])) for pin in pins]
    farthest = 0
    for link, distance in ends:
        while link in joints:
            joint = joints[link]
            distance += origin(joint)
            if joint.get('type') == 'prismatic':
                distance += slides.get(joint.get('name'), 0)
            link = joint.find('parent').get('link')
        farthest = max(farthest, distance)
    return farthest or 1.0


def look_at(size, scene, view):
    """Aims the camera; at mechanisms that stand upright in the plane of x and y it looks along z."""
    x, y, z = (float(component) for component in scene.get('gravity') or [0, 0, -GRAVITY])
    if math.hypot(x, y) > abs(z):
        view.clear()
        view.update({'Class': 'rviz/TopDownOrtho', 'Name': 'Current View', 'X': 0, 'Y': 0,
                     'Angle': math.atan2(x, -y), 'Scale': PIXELS / size,
                     'Target Frame': '<Fixed Frame>', 'Value': 'TopDownOrtho (rviz)'})
        return
    view['Distance'] = DISTANCE * size
    view['Focal Point']['Z'] = FOCUS * size


def read_scene(path):
    scene = {} if path == 'none' else yaml.safe_load(pathlib.Path(path).read_text()) or {}
    closures = scene.get('closures') or [] if isinstance(scene, dict) else [None]
    if not all(isinstance(closure, dict) and 'name' in closure for closure in closures):
        raise ValueError('not a scene, or one with a closure without a name')
    return scene


def configuration(robot, scene, template, frame):
    children = {joint.find('child').get('link') for joint in robot.findall('joint')}
    roots = [link.get('name') for link in robot.findall('link') if link.get('name') not in children]
    if len(roots) != 1:
        raise ValueError('the robot has %d root links' % len(roots))
    mass = sum(float(mass.get('value')) for mass in robot.iterfind('link/inertial/mass')) or 1.0
    manager = template['Visualization Manager']
    manager['Global Options']['Fixed Frame'] = frame or roots[0]
    sample = next(d for d in manager['Displays'] if d['Class'] == 'rviz/WrenchStamped')
    manager['Displays'].remove(sample)
    size = reach(robot, scene)
    look_at(size, scene, manager['Views']['Current'])
    reactions = []
    for name in reactions_of(robot, scene):
        display = copy.deepcopy(sample)
        display.update({'Name': name, 'Topic': topic(name),
                        'Arrow Width': WIDTH * size,
                        'Force Arrow Scale': ARROW * size / (mass * GRAVITY),
                        'Torque Arrow Scale': 1 / (mass * GRAVITY)})
        reactions.append(display)
    manager['Displays'].append({'Class': 'rviz/Group', 'Name': 'Reactions', 'Enabled': True,
                                'Displays': reactions})
    for display in manager['Displays']:
        if display['Class'] == 'rviz/Grid':
            display['Reference Frame'] = '<Fixed Frame>'
    return template


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('robot', help='path of the URDF')
    parser.add_argument('--scene', default='none', help='path of the scene YAML; none: defaults')
    parser.add_argument('--frame', default='', help='fixed frame (the root link)')
    parser.add_argument('--template', default=str(TEMPLATE), help='RViz configuration to fill')
    parser.add_argument('--print', action='store_true', help='print the configuration')
    arguments, rviz_arguments = parser.parse_known_args()
    read = arguments.scene
    try:
        scene = read_scene(read)
        read = arguments.robot
        robot = ElementTree.parse(read).getroot()
        read = arguments.template
        template = yaml.safe_load(pathlib.Path(read).read_text())
        read = arguments.robot
        config = configuration(robot, scene, template, arguments.frame)
    except (OSError, ValueError, ElementTree.ParseError, yaml.YAMLError) as problem:
        text = ' '.join(str(getattr(problem, 'strerror', None) or problem).split())
        print('rviz_for_robot.py: %s: %s' % (read, text), file=sys.stderr)
        return 1
    text = yaml.safe_dump(config, sort_keys=False)
    if arguments.print:
        print(text, end='')
        return 0
    path = os.path.join(tempfile.mkdtemp(prefix='rviz_for_robot_'), 'robot.rviz')
    pathlib.Path(path).write_text(text)
    os.execvp('rviz', ['rviz', '-d', path] + rviz_arguments)
    return 1


if __name__ == '__main__':
    sys.exit(main())
