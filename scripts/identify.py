#!/usr/bin/python3
"""Finds what a robot description does not know from a recording with measured efforts.

Friction, rotor inertia, payload, inertial parameters and motor gains are fitted to measured efforts of a
part of the recording and judged on the rest. See doc/identification.md.
"""
import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from identification.refusal import Refusal  # noqa: E402 (the folder has to be known first)

EXAMPLES = """\
what can be fitted (--fit, separated by commas)
  friction      viscous and dry friction of every joint: damping and coulomb of the scene
  viscous, dry  one of the two
  offset        a constant effort of every joint
  rotor         the inertia of every joint's rotor, as the joint feels it
  coupled:A+B   viscous and dry friction by the sum of the speeds of joints A and B (A-B: the difference),
                as of a wrist with bevel gears; reported, as a scene has no key for it
  payload:LINK  mass, centre of mass and inertia of what LINK carries
  base          all inertial parameters of all links that joints move
  gain          what one unit of each measured effort is in N m or N: needs --masses-known, or --unloaded
                and a payload in the scene that is known

examples
  identify.py --urdf arm.urdf --motion run.csv --output found
  identify.py --urdf arm.urdf --motion loaded.csv --unloaded empty.csv --fit friction,offset,payload:flange \\
      --output found
"""


def parser():
    result = argparse.ArgumentParser(
        prog='identify.py', description=__doc__, epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    add = result.add_argument
    add('--urdf', required=True, metavar='FILE', help='robot description')
    add('--motion', required=True, nargs='+', metavar='FILE',
        help='recording, as inverse_dynamics_offline reads it; a CSV may have the columns effort.<joint>')
    add('--measured', metavar='FILE', help='measured efforts, N m or N, where they are not in --motion; as of '
        'inverse_dynamics_offline')
    add('--measured-topic', metavar='NAME', help='topic of the joint states in --measured, as of '
        'inverse_dynamics_offline')
    add('--scene', metavar='FILE', help='scene file of the robot as it was recorded')
    add('--fit', default='friction,offset', metavar='LIST', help='what is fitted (default: friction,offset)')
    add('--fit-until', type=float, metavar='S', help='seconds from the start that are fitted; the rest judges '
        '(default: two thirds of the recording)')
    add('--validation', metavar='FILE', help='another recording that judges, with effort.<joint>; all of '
        '--motion is then fitted')
    add('--unloaded', metavar='FILE', help='another recording, with effort.<joint>, of the robot without its '
        'payload, fitted together with --motion')
    add('--masses-known', action='store_true', help='for gain: the masses of the description are exact')
    add('--cutoff', type=float, metavar='HZ', help='low pass of both sides of the regression (default: five '
        'times the highest frequency of the motion)')
    add('--coulomb-velocity', type=float, default=0.02, metavar='X', help='speed from which dry friction acts '
        'in full, rad/s or m/s, where the scene does not say it (default: 0.02)')
    add('--output', required=True, metavar='DIR', help='folder for scene.yaml, report.md, plots, '
        'parameters.csv and, for base, robot.urdf')
    add('--tool', metavar='FILE', help='the program inverse_dynamics_offline (default: the one of this package)')
    for option, value in (('--rename', 'RULE'), ('--topic', 'NAME'), ('--max-gap', 'S'), ('--rest', 'JOINT=X'),
                          ('--bandwidth', 'HZ'), ('--position-noise', 'X'), ('--velocity-noise', 'X'),
                          ('--stamp-noise', 'X'), ('--threads', 'N')):
        add(option, metavar=value, action='append', help='as of inverse_dynamics_offline')
    add('--degrees', action='store_true', help='as of inverse_dynamics_offline')
    add('--verbose', action='store_true', help='show what inverse_dynamics_offline notes, too')
    return result


def tool_options(arguments):
    """The options of the motion that the offline tool gets."""
    options = ['--degrees'] if arguments.degrees else []
    for name in ('rename', 'topic', 'max_gap', 'rest', 'bandwidth', 'position_noise', 'velocity_noise',
                 'stamp_noise', 'threads'):
        for value in getattr(arguments, name) or []:
            options += ['--' + name.replace('_', '-'), value]
    return options


def missing_modules():
    missing = []
    for module, package in (('numpy', 'python3-numpy'), ('scipy', 'python3-scipy'), ('yaml', 'python3-yaml')):
        try:
            __import__(module)
        except ImportError:
            missing.append(package)
    return missing


def main(words):
    arguments = parser().parse_args(words)
    missing = missing_modules()
    if missing:
        print('identify.py: error: needs %s (Debian, Ubuntu: sudo apt install %s)'
              % (' and '.join(missing), ' '.join(missing)), file=sys.stderr)
        return 1
    from identification.study import Study
    try:
        Study(arguments, tool_options(arguments), __file__).run()
        return 0
    except Refusal as problem:
        print('identify.py: error: %s' % problem, file=sys.stderr)
    except OSError as problem:
        print('identify.py: error: %s: %s' % (problem.filename, problem.strerror), file=sys.stderr)
    return 1


if __name__ == '__main__':
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
