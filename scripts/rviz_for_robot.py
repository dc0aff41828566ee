#!/usr/bin/python3
"""Shows a robot and the reaction wrench of every movable joint in RViz.

Usage: rviz_for_robot.py [--frame FRAME] [--template RVIZ] [--print] ROBOT.urdf [RVIZ_ARGUMENT ...]

Fills a template (the package's config/inverse_dynamics.rviz) with the robot's root link as fixed frame
and one arrow display for each joint, scaled by the robot's weight, and starts RViz with it. With
--print the configuration goes to standard output instead, as a start for one of your own.
"""
import argparse
import copy
import os
import pathlib
import re
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import yaml

# An arrow of the robot's whole weight is this long, m, and so is one of the
# weight times half a metre.
ARROW = 0.8
GRAVITY = 9.81
TEMPLATE = pathlib.Path(__file__).resolve().parent.parent / 'config' / 'inverse_dynamics.rviz'
MOVABLE = ('revolute', 'continuous', 'prismatic')


def topic(joint):
    """The node's topic of a joint: illegal characters become an underscore."""
    name = re.sub('[^A-Za-z0-9_]', '_', joint)
    return '/inverse_dynamics/reaction/' + ('_' + name if name[:1].isdigit() else name)


def configuration(robot, template, frame):
    joints = robot.findall('joint')
    children = {joint.find('child').get('link') for joint in joints}
    roots = [link.get('name') for link in robot.findall('link') if link.get('name') not in children]
    if len(roots) != 1:
        raise ValueError('the robot has %d root links' % len(roots))
    mass = sum(float(mass.get('value')) for mass in robot.iterfind('link/inertial/mass')) or 1.0
    manager = template['Visualization Manager']
    manager['Global Options']['Fixed Frame'] = frame or roots[0]
    sample = next(d for d in manager['Displays'] if d['Class'] == 'rviz/WrenchStamped')
    manager['Displays'].remove(sample)
    reactions = []
    for joint in joints:
        if joint.get('type') not in MOVABLE:
            continue
        display = copy.deepcopy(sample)
        display.update({'Name': joint.get('name'), 'Topic': topic(joint.get('name')),
                        'Force Arrow Scale': ARROW / (mass * GRAVITY),
                        'Torque Arrow Scale': 2 * ARROW / (mass * GRAVITY)})
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
    parser.add_argument('--frame', default='', help='fixed frame (the root link)')
    parser.add_argument('--template', default=str(TEMPLATE), help='RViz configuration to fill')
    parser.add_argument('--print', action='store_true', help='print the configuration')
    arguments, rviz_arguments = parser.parse_known_args()
    try:
        config = configuration(ElementTree.parse(arguments.robot).getroot(),
                               yaml.safe_load(pathlib.Path(arguments.template).read_text()), arguments.frame)
    except (OSError, ValueError, ElementTree.ParseError) as problem:
        print('rviz_for_robot.py: %s: %s' % (arguments.robot, problem), file=sys.stderr)
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
