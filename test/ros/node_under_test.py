"""inverse_dynamics_node as a process of a test's own, with its topics and diagnostics.

Nothing here sleeps for a fixed time or asserts how long something takes: every wait is for an
event, and its patience only ends what never happens.
"""
import itertools
import math
import os
import re
import signal
import subprocess
import tempfile
import threading
import time
import unittest
import xmlrpc.client

from diagnostic_msgs.msg import DiagnosticArray
import genpy
import numpy as np
import rosgraph
import roslib.packages
import rospy
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectoryPoint

import junit

PACKAGE = 'virtual_work_dynamics'
PATIENCE = 90  # s
HERE = os.path.dirname(os.path.abspath(__file__))
# An instant to count from, with all its nanoseconds.
EPOCH = 1600000000123456789
# Of every node: reports soon, no message lost however late it gets a core, and nothing too late.
PARAMETERS = {'diagnostic_period': 0.05, 'late_threshold': 1000,
              'queue_size': {'input': 100000, 'output': 100000}}
_numbers = itertools.count(1)


def read(*path):
    with open(os.path.join(HERE, *path), encoding='utf-8') as file:
        return file.read()


def executable(name):
    return roslib.packages.find_node(PACKAGE, name)[0]


def wait_until(condition, what):
    """Waits until condition() is true, and returns it; `what` may be a function, too."""
    end = time.monotonic() + PATIENCE
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end or rospy.is_shutdown():
            raise AssertionError('waited in vain for ' + (what() if callable(what) else what))
        time.sleep(0.005)


def ros_time(ns):
    return genpy.Time(*divmod(ns, 1000000000))


def joint_state(ns, positions, velocities=None):
    """A message with the joints in the order of the map `positions`."""
    message = JointState(name=list(positions), position=list(positions.values()))
    message.header.stamp = ros_time(ns)
    if velocities is not None:
        message.velocity = [velocities[name] for name in positions]
    return message


def trajectory_point(ns, names, motion, parts=3):
    """A point with the first `parts` of positions, velocities and accelerations."""
    point = JointTrajectoryPoint(time_from_start=genpy.Duration(*divmod(ns, 1000000000)))
    fields = (point.positions, point.velocities, point.accelerations)
    for field, values in list(zip(fields, motion))[:parts]:
        field.extend(values[name] for name in names)
    return point


def vector(message):
    return [message.x, message.y, message.z]


def rotated(quaternion, axis):
    """The unit vector of an axis turned by a quaternion."""
    w, v = quaternion.w, np.array(vector(quaternion))
    unit = np.eye(3)[axis]
    return 2 * np.dot(v, unit) * v + (w * w - np.dot(v, v)) * unit + 2 * w * np.cross(v, unit)


class Polynomials:
    """A motion whose coordinates are polynomials of the time since `start`, ns."""

    def __init__(self, start=EPOCH, **coefficients):
        self._start = start
        self._coefficients = coefficients

    def __call__(self, ns):
        """q, q', q'' as maps by name."""
        t = (ns - self._start) / 1e9
        motion = ({}, {}, {})
        for name, coefficients in self._coefficients.items():
            for order, values in enumerate(motion):
                values[name] = sum(math.perm(k, order) * c * t ** (k - order)
                                   for k, c in enumerate(coefficients) if k >= order)
        return motion


class Process:
    """A program with what it says in a file; killed at the end of the test."""

    def __init__(self, test, arguments, environment=None, inherited=os.environ, folder=None):
        """In `folder`, with `environment` in addition to what is `inherited`."""
        self._log = tempfile.NamedTemporaryFile(prefix='vwd_test_', suffix='.log')
        test.addCleanup(self._log.close)
        environment = dict(inherited, ROSCONSOLE_STDOUT_LINE_BUFFERED='1', **(environment or {}))
        self._process = subprocess.Popen(arguments, stdout=self._log, stderr=subprocess.STDOUT,
                                         env=environment, cwd=folder)
        test.addCleanup(self._kill)

    def _kill(self):
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()

    def interrupt(self):
        self._process.send_signal(signal.SIGINT)

    def ended(self):
        return self._process.poll() is not None

    def wait(self):
        """The exit code."""
        wait_until(self.ended, lambda: 'the end of a process that says ' + self.output())
        return self._process.returncode

    def output(self):
        with open(self._log.name, encoding='utf-8', errors='replace') as file:
            return re.sub('\x1b\\[[0-9;]*m', '', file.read())

    def lines(self, severity):
        """What was logged as FATAL, WARN or the like."""
        return re.findall(r'^\[ ?%s\] \[[^]]*\]: (.*)$' % severity, self.output(), re.MULTILINE)


class Recorder:
    """All messages of a topic, as they came over the wire."""

    def __init__(self, topic, kind):
        self.topic = topic
        self.raw = []
        self._kind = kind
        self._read = []
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._take)

    def _take(self, message):
        self.raw.append(message._buff)

    def messages(self):
        for raw in self.raw[len(self._read):]:
            message = self._kind()
            message.deserialize(raw)
            self._read.append(message)
        return self._read

    def wait(self, count):
        """Waits for so many messages and returns all that are there."""
        wait_until(lambda: len(self.raw) >= count, lambda: 'message %d of %s, there are %d' % (
            count, self.topic, len(self.raw)))
        return self.messages()

    def stop(self):
        self._subscriber.unregister()


class Node(Process):
    """The node, in a namespace of its own."""

    def __init__(self, test, robot, parameters=None, arguments=(), environment=None):
        self.test = test
        self.namespace = '/robot_%d' % next(_numbers)
        self.name = self.namespace + '/inverse_dynamics'
        if robot is not None:
            rospy.set_param(self.namespace + '/robot_description', robot)
        rospy.set_param(self.name, dict(PARAMETERS, **(parameters or {})))
        self._statuses = []
        self._new_status = threading.Condition()
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._take_diagnostics)
        test.addCleanup(subscriber.unregister)
        super().__init__(test, [executable('inverse_dynamics_node'), '__ns:=' + self.namespace,
                                '__name:=inverse_dynamics', *arguments], environment)

    def _take_diagnostics(self, message):
        for status in message.status:
            # A first one without values only says that the node starts up.
            if status.name == self.name[1:] + ': inverse dynamics' and status.values:
                with self._new_status:
                    self._statuses.append(status)
                    self._new_status.notify_all()

    def statuses(self):
        """Every DiagnosticStatus so far."""
        with self._new_status:
            return list(self._statuses)

    def diagnostics(self, condition=lambda values: True, what='diagnostics'):
        """The values of the next report that meets the condition."""
        with self._new_status:
            seen = len(self._statuses)
        end = time.monotonic() + PATIENCE
        while True:
            with self._new_status:
                while seen == len(self._statuses):
                    if not self._new_status.wait(1) and (
                            self.ended() or rospy.is_shutdown() or time.monotonic() > end):
                        raise AssertionError('waited in vain for %s; the last report: %s; the log: '
                                             '%s' % (what, self._statuses[-1:], self.output()))
                status = self._statuses[seen]
                seen += 1
            values = {entry.key: entry.value for entry in status.values}
            if condition(values):
                return values
            if time.monotonic() > end:
                raise AssertionError('waited in vain for %s; the last report: %s' % (what, values))

    def wait_for_status(self, *parts):
        """The first DiagnosticStatus of all so far, or of those to come, that says these texts."""
        return wait_until(
            lambda: next((status for status in self.statuses()
                          if all(part in status.message for part in parts)), None),
            lambda: 'a report of %s; the last one: %s' % (parts, self.statuses()[-1:]))

    def wait_for_line(self, severity, *parts):
        """The first line of the log that says these texts."""
        return wait_until(lambda: next((line for line in self.lines(severity)
                                        if all(part in line for part in parts)), None),
                          lambda: '%s in %s' % (parts, self.output()))

    def wait_for_plan(self, *topics):
        """Waits until exactly these outputs are subscribed to and computed from now on."""
        wanted = {self.name + '/' + topic for topic in topics} or {'none'}
        return self.diagnostics(
            lambda values: set(values['subscribed outputs'].split(', ')) == wanted,
            'the plan for %s' % sorted(wanted))

    def wait_for_count(self, key, count):
        """Waits until a count in the diagnostics has come up to a value."""
        return self.diagnostics(lambda values: int(values[key]) >= count,
                                '%s = %d' % (key, count))

    def record(self, topic, kind):
        recorder = Recorder(self.name + '/' + topic, kind)
        self.test.addCleanup(recorder.stop)
        return recorder

    def feed(self, topic, kind):
        """A publisher that the node is connected to; of a topic of its namespace or, with /, of all."""
        name = topic if topic.startswith('/') else self.namespace + '/' + topic
        publisher = rospy.Publisher(name, kind, queue_size=100000)
        self.test.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0,
                   lambda: 'the node to subscribe to %s; it says %s' % (topic, self.output()))
        return publisher

    def connections(self, topic, direction):
        """Names at the other ends of a topic's connections; direction 'i' or 'o'."""
        uri = rosgraph.Master('/test').lookupNode(self.name)
        code, text, bus = xmlrpc.client.ServerProxy(uri).getBusInfo('/test')
        self.test.assertEqual(code, 1, text)
        return [entry[1] for entry in bus if entry[2] == direction and entry[4] == topic]


class NodeTest(unittest.TestCase):
    """With comparisons that NaN does not slip through."""

    longMessage = True

    def assertClose(self, actual, expected, tolerance, what):
        """Each number within tolerance * max(1, |expected|)."""
        self.assertEqual(len(actual), len(expected), what)
        for got, wanted in zip(actual, expected):
            self.assertTrue(math.isfinite(got), what)
            self.assertLessEqual(abs(got - wanted), tolerance * max(1, abs(wanted)),
                                 '%s: %r is not %r' % (what, got, wanted))

    def assertEffort(self, message, bodies, motion, tolerance):
        """A message of ~effort against the oracle; motion as maps q, q', q'' by name."""
        what = 'at %s' % message.header.stamp
        self.assertEqual(message.header.frame_id, bodies.root)
        self.assertClose(message.position, [motion[0][name] for name in message.name], tolerance,
                         'positions ' + what)
        self.assertClose(message.velocity, [motion[1][name] for name in message.name], tolerance,
                         'velocities ' + what)
        self.assertClose(message.effort, [bodies.effort(name, *motion) for name in message.name],
                         tolerance, 'efforts ' + what)

    def assertReactions(self, message, bodies, motion, tolerance):
        """A message of ~reactions against the oracle."""
        self.assertEqual(message.header.frame_id, bodies.root)
        self.assertEqual(len(message.wrench), len(message.joint_names))
        self.assertEqual(len(message.transforms), len(message.joint_names))
        for name, wrench, pose in zip(message.joint_names, message.wrench, message.transforms):
            what = 'of %s at %s' % (name, message.header.stamp)
            reaction = bodies.reaction(name, *motion)
            self.assertClose(vector(wrench.force), reaction.force, tolerance, 'force ' + what)
            self.assertClose(vector(wrench.torque), reaction.torque, tolerance, 'torque ' + what)
            self.assertClose(vector(pose.translation), reaction.pose[:3, 3], tolerance,
                             'position ' + what)
            # Turns each axis as the oracle's rotation matrix does, whatever the sign of the
            # quaternion.
            for axis in range(3):
                self.assertClose(rotated(pose.rotation, axis), reaction.pose[:3, axis], tolerance,
                                 'axis %d %s' % (axis, what))

    def assertWrench(self, message, bodies, joint, motion, tolerance):
        """A message of ~reaction/<joint>, in axes of the child link, against the oracle."""
        what = 'of %s at %s' % (joint, message.header.stamp)
        reaction = bodies.reaction(joint, *motion)
        to_child = reaction.pose[:3, :3].T
        self.assertClose(vector(message.wrench.force), to_child @ reaction.force, tolerance,
                         'force ' + what)
        self.assertClose(vector(message.wrench.torque), to_child @ reaction.torque, tolerance,
                         'torque ' + what)

    def assertStamps(self, messages, stamps):
        """Exactly these, ns, in this order."""
        # Not assertEqual: it takes minutes over what differs in lists of thousands.
        for i, (message, ns) in enumerate(zip(messages, stamps)):
            self.assertEqual(message.header.stamp.to_nsec(), ns, 'message %d' % i)
        self.assertEqual(len(messages), len(stamps))

    def assertThrottled(self, lines, start):
        """One at the least, and no more than one a second since time.monotonic() was `start`."""
        self.assertGreaterEqual(len(lines), 1)
        self.assertLessEqual(len(lines), 1 + (time.monotonic() - start), lines)

    def assertNoGaps(self, messages):
        """Sequence numbers count up by one."""
        for i, message in enumerate(messages):
            self.assertEqual(message.header.seq, messages[0].header.seq + i, 'message %d' % i)


def run(*cases):
    rospy.init_node('inverse_dynamics_test', anonymous=True)
    junit.run(cases)
