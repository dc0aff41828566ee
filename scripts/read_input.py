#!/usr/bin/python3
"""Prints what a file has for the parameter server, for the launch files.

Usage: read_input.py robot|scene FILE

robot: the text of a URDF as it is, or what xacro makes of a .xacro file: the command in PATH, or else that
of the ROS package xacro.
scene: the keys of a scene file as JSON, read as the offline tool reads them. roslaunch's own reader takes
the joint `on` for true and keys that are given twice in silence.
Whatever is wrong is said in one line.
"""
import json
import os
import re
import shlex
import shutil
import subprocess
import sys

MOST = 256 * 1024 * 1024  # bytes: far beyond any description, for files that never end
LARGEST = 1000000  # values of a scene, aliases replaced by what they stand for
DEEPEST = 64
NUMBER = re.compile(r'-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?')


class Refusal(Exception):
    """What is wrong with the file."""


def in_one_line(text):
    return '; '.join(' '.join(line.split()) for line in text.splitlines() if line.strip())


def read(path):
    with open(path, 'rb') as file:
        text = file.read(MOST + 1)
    if len(text) > MOST:
        raise Refusal('never ends, or is longer than any input')
    try:
        return text.decode('utf-8')
    except UnicodeDecodeError:
        raise Refusal('is not text in UTF-8') from None


# --- robot


def xacro_command():
    """The start of a command line that runs xacro, or nothing."""
    if shutil.which('xacro'):
        return ['xacro']
    if not shutil.which('rosrun') or not shutil.which('rospack'):
        return []
    found = subprocess.run(['rospack', 'find', 'xacro'], stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, check=False)
    return ['rosrun', 'xacro', 'xacro'] if found.returncode == 0 else []


def expanded(path):
    read(path)  # says what is wrong with the file itself
    command = xacro_command()
    if not command:
        raise Refusal('needs xacro, which is not installed (ROS Noetic: sudo apt install '
                      'ros-noetic-xacro); or run where it is: xacro %s > robot.urdf, and launch with '
                      'robot:=robot.urdf' % shlex.quote(os.path.basename(path)))
    # A path that begins with a dash is a path, too.
    result = subprocess.run(command + [os.path.join('.', path)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, check=False)
    said = result.stderr.decode('utf-8', 'replace')
    if result.returncode != 0:
        raise Refusal('xacro cannot expand it: ' + (in_one_line(said) or
                                                    'exit code %d' % result.returncode))
    sys.stderr.write(said)
    return result.stdout.decode('utf-8', 'replace')


def robot(path):
    return expanded(path) if path.lower().endswith('.xacro') else read(path)


# --- scene


def number(text):
    """The number that a text is, if it is written anew as the same text, or nothing."""
    if not NUMBER.fullmatch(text):
        return None
    value = float(text) if re.search('[.eE]', text) else int(text)
    return value if repr(value) == text and abs(value) < 2 ** 31 else None


class Document:
    """The values of a document of YAML: texts, but for numbers and booleans that are not in quotes and
    are the same text again in the node. Made of events, of which no depth or alias is too much."""

    def __init__(self, yaml, events):
        self._yaml = yaml
        self._events = events
        self._count = 0
        self._anchors = {}  # values, and how many they are

    def read(self):
        """The only document, or nothing where there is none."""
        values = {}
        documents = 0
        for event in self._events:
            if isinstance(event, self._yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    raise Refusal('has more than one document')
                values = self._value(next(self._events), 0)
        return values

    def _value(self, event, depth):
        before = self._count
        if isinstance(event, self._yaml.AliasEvent):
            if event.anchor not in self._anchors:
                raise self._refusal(event, 'there is no value *%s yet' % event.anchor)
            value, count = self._anchors[event.anchor]
            self._add(event, count)
            return value
        if depth > DEEPEST:
            raise self._refusal(event, 'is nested more than %d deep' % DEEPEST)
        self._add(event, 1)
        if isinstance(event, self._yaml.SequenceStartEvent):
            value = [self._value(entry, depth + 1)
                     for entry in iter(self._next_in(self._yaml.SequenceEndEvent), None)]
        elif isinstance(event, self._yaml.MappingStartEvent):
            value = self._map(depth)
        else:
            value = self._scalar(event)
        if event.anchor:
            self._anchors[event.anchor] = (value, self._count - before)
        return value

    def _next_in(self, end):
        """A function that gives the next event, and None for the end of a list or map."""
        def next_event():
            event = next(self._events)
            return None if isinstance(event, end) else event
        return next_event

    def _map(self, depth):
        values = {}
        for key in iter(self._next_in(self._yaml.MappingEndEvent), None):
            if not isinstance(key, self._yaml.ScalarEvent):
                raise self._refusal(key, 'a key is not a word')
            if key.value in values:
                raise self._refusal(key, key.value + ': given twice')
            # What is not a legal name of a parameter is not a key of a scene either.
            if not re.fullmatch('[A-Za-z][A-Za-z0-9_]*', key.value):
                raise self._refusal(key, '%r: unknown key' % key.value)
            values[key.value] = self._value(next(self._events), depth + 1)
        return values

    @staticmethod
    def _scalar(event):
        if event.style in ('"', "'"):
            return event.value
        if event.value in ('true', 'false'):
            return event.value == 'true'
        value = number(event.value)
        return event.value if value is None else value

    def _add(self, event, count):
        self._count += count
        if self._count > LARGEST:
            raise self._refusal(event, 'there are more than a million values')

    @staticmethod
    def _refusal(event, problem):
        return Refusal('line %d: %s' % (event.start_mark.line + 1, problem))


def scene(path):
    import yaml  # which takes a while, and which a robot does not need
    text = read(path)
    try:
        loader = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
        values = Document(yaml, yaml.parse(text, Loader=loader)).read()
    except yaml.MarkedYAMLError as problem:
        mark = problem.problem_mark or problem.context_mark
        place = 'line %d, column %d: ' % (mark.line + 1, mark.column + 1) if mark else ''
        raise Refusal('is not valid YAML: ' + place + (problem.problem or problem.context)) from None
    except yaml.YAMLError as problem:
        raise Refusal('is not valid YAML: ' + in_one_line(str(problem))) from None
    if values == '':  # nothing but a comment, or null
        values = {}
    if not isinstance(values, dict):
        raise Refusal('is not a map of keys')
    # What YAML, as which roslaunch reads it, would take for the end of a line is escaped.
    return re.sub('[\x7f-\x9f\u2028\u2029\ufeff]', lambda match: '\\u%04x' % ord(match[0]),
                  json.dumps(values, ensure_ascii=False))


def main():
    kinds = {'robot': robot, 'scene': scene}
    if sys.argv[1:] in (['-h'], ['--help']):
        print(__doc__.strip())
        return 0
    if len(sys.argv) != 3 or sys.argv[1] not in kinds:
        print('usage: read_input.py robot|scene FILE', file=sys.stderr)
        return 2
    kind, path = sys.argv[1:]
    try:
        sys.stdout.buffer.write(kinds[kind](path).encode('utf-8'))
        return 0
    except OSError as error:
        problem = error.strerror or str(error)
    except Refusal as error:
        problem = str(error)
    print('%s:=%s: %s' % (kind, path, problem), file=sys.stderr)
    return 1


if __name__ == '__main__':
    sys.exit(main())
