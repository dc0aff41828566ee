#!/usr/bin/python3
"""Prints the description of a robot, for the launch files.

Usage: read_robot.py ROBOT

ROBOT is the path of a URDF, which is printed as it is, or of a .xacro file, which xacro expands: the
command in PATH, or else that of the ROS package xacro. Whatever is wrong is said in one line.
"""
import os
import shlex
import shutil
import subprocess
import sys

MOST = 256 * 1024 * 1024  # bytes: far beyond any description, for files that never end


class Refusal(Exception):
    """What is wrong with the robot."""


def read(path):
    with open(path, 'rb') as file:
        text = file.read(MOST + 1)
    if len(text) > MOST:
        raise Refusal('is longer than any description of a robot')
    return text


def xacro_command():
    """The start of a command line that runs xacro, or nothing."""
    if shutil.which('xacro'):
        return ['xacro']
    if not shutil.which('rosrun') or not shutil.which('rospack'):
        return []
    found = subprocess.run(['rospack', 'find', 'xacro'], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, check=False)
    return ['rosrun', 'xacro', 'xacro'] if found.returncode == 0 else []


def in_one_line(text):
    return '; '.join(' '.join(line.split()) for line in text.splitlines() if line.strip())


def expanded(path):
    read(path)  # says what is wrong with the file itself
    command = xacro_command()
    if not command:
        name = os.path.basename(path)
        raise Refusal('needs xacro, which is not installed (ROS Noetic: sudo apt install '
                      'ros-noetic-xacro); or run where it is: xacro %s > robot.urdf, and launch with '
                      'robot:=robot.urdf' % shlex.quote(name))
    # A path that begins with a dash is a path, too.
    result = subprocess.run(command + [os.path.join('.', path)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, check=False)
    said = result.stderr.decode('utf-8', 'replace')
    if result.returncode != 0:
        raise Refusal('xacro cannot expand it: ' + (in_one_line(said) or
                                                    'exit code %d' % result.returncode))
    sys.stderr.write(said)
    return result.stdout


def main():
    if len(sys.argv) != 2 or sys.argv[1] in ('-h', '--help'):
        print(__doc__.strip())
        return 0 if sys.argv[1:] in (['-h'], ['--help']) else 2
    path = sys.argv[1]
    try:
        text = expanded(path) if path.lower().endswith('.xacro') else read(path)
        text.decode('utf-8')  # as roslaunch will
    except OSError as problem:
        print('robot:=%s: %s' % (path, problem.strerror or problem), file=sys.stderr)
        return 1
    except UnicodeDecodeError:
        print('robot:=%s: is not text in UTF-8' % path, file=sys.stderr)
        return 1
    except Refusal as problem:
        print('robot:=%s: %s' % (path, problem), file=sys.stderr)
        return 1
    sys.stdout.buffer.write(text)
    return 0


if __name__ == '__main__':
    sys.exit(main())
