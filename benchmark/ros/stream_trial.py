"""Joint states of a robot at a set rate through inverse_dynamics_node into a bag."""
import collections
import os
import pathlib
import re
import time
import xml.etree.ElementTree as ElementTree

import roslib.packages
import yaml

from recorded_run import COPY, DIAGNOSTICS, INPUT, NODE, RecordedRun
from ros_session import SessionError

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent.parent
PARAMETERS = REPOSITORY / 'config' / 'inverse_dynamics.yaml'
RECORDER_BUFFER = 2048  # MB, as in inverse_dynamics.launch
RECORDER = '/recorder'
SETTLE = 2.0  # s for connections and plans to settle before the first joint state
DRAIN = 2.5  # s after the last one: two reports on /diagnostics
AMPLITUDE = 0.1  # rad or m
FREQUENCIES = (0.1, 1.0)  # Hz, of the sine sweep


def moving_joints(robot):
    """Names of the joints of a URDF that move by themselves."""
    try:
        root = ElementTree.parse(robot).getroot()
    except ElementTree.ParseError as problem:
        raise SessionError('%s: %s' % (robot, problem))
    return [joint.get('name') for joint in root.findall('joint')
            if joint.get('type') in ('revolute', 'continuous', 'prismatic')
            and joint.find('mimic') is None]


def start_dynamics(session, programs, robot, joint_states=INPUT):
    """Starts inverse_dynamics_node with its default parameters: (process, parameters)."""
    parameters = yaml.safe_load(PARAMETERS.read_text())
    session.set_parameter('/robot_description', pathlib.Path(robot).read_text())
    session.set_parameter('/inverse_dynamics', parameters)
    process = session.start('inverse_dynamics', [
        programs / 'inverse_dynamics_node', '__name:=inverse_dynamics',
        'joint_states:=' + joint_states], measured=True)
    session.wait('inverse_dynamics', lambda: NODE + 'effort' in session.published())
    return process, parameters


def start_copy(session, programs, joint_states=INPUT):
    process = session.start('copy', [
        programs / 'copy_node', '__name:=copy', 'joint_states:=' + joint_states], measured=True)
    session.wait('copy', lambda: COPY in session.published())
    return process


class Usage:
    """CPU and memory of processes, and of the machine, while joint states flow."""

    def __init__(self, processes):
        self.processes = processes
        self.rows = []

    def sample(self):
        with open('/proc/stat') as stat:
            machine = [int(field) for field in stat.readline().split()[1:9]]
        self.rows.append((time.monotonic(), machine, [
            (process.cpu_seconds(), process.resident_mb()) for process in self.processes]))

    def table(self):
        """[(name, CPU share of one core, MB at the start, MB at the end)]"""
        (begin, _, first), (end, _, last) = self.rows[0], self.rows[-1]
        return [(process.name, (b[0] - a[0]) / (end - begin), a[1], b[1])
                for process, a, b in zip(self.processes, first, last)]

    def machine(self):
        """Shares of one core that were busy, and that the host gave to others."""
        spent = [b - a for a, b in zip(self.rows[0][1], self.rows[-1][1])]
        idle, stolen = spent[3] + spent[4], spent[7]
        cores = os.cpu_count() / sum(spent)
        return cores * (sum(spent) - idle - stolen), cores * stolen


Loss = collections.namedtuple('Loss', 'topic expected sent recorder_dropped recorded gaps stamps')
Loss.__doc__ = """What became of a topic's messages. sent: left the node for the recorder, which
dropped recorder_dropped of them because its own queue was full; None where nobody counts."""


class StreamTrial:
    """One run with all outputs subscribed and recorded, and what became of the messages."""

    def __init__(self, session, programs, robot, rate, seconds, with_copy, progress):
        self.rate = rate
        self.seconds = seconds
        self._session = session
        self._progress = progress
        node, parameters = start_dynamics(session, programs, robot)
        self._lag = parameters['estimator']['lag']
        self.queues = parameters['queue_size']
        watched = [node]
        if with_copy:
            watched.append(start_copy(session, programs))
        outputs = sorted(topic for topic in session.published() if topic.startswith(NODE))
        # Recorded like the others, but joint states make none of it.
        topics = [INPUT] + ([COPY] if with_copy else []) + [
            topic for topic in outputs if topic != NODE + 'joint_trajectory']
        recorder, bag = self._start_recorder(sorted(set(topics + outputs + [DIAGNOSTICS])))
        source = self._start_source(programs, moving_joints(robot), len(watched) + 1)
        self.usage = Usage(watched + [recorder, source])
        self._watch(source)
        sent, dropped = self._bus_counts(watched)
        recorder.stop()
        self.joint_states = self._published(source)
        self.run = RecordedRun(bag, topics, progress)
        self.losses = [self._loss(topic, sent, dropped) for topic in topics]

    def _start_recorder(self, topics):
        bag = self._session.folder / 'run.bag'
        recorder = self._session.start('recorder', [
            roslib.packages.find_node('rosbag', 'record')[0], '__name:=recorder', '--quiet',
            '--buffsize=%d' % RECORDER_BUFFER, '-O', bag] + topics)
        for topic in topics:
            self._session.wait('recorder of %s' % topic,
                               lambda name=topic: RECORDER in self._session.subscribers(name))
        return recorder, bag

    def _start_source(self, programs, joints, subscribers):
        self._session.set_parameter('/source', {
            'joints': joints, 'law': 'sine_sweep', 'amplitudes': [AMPLITUDE] * len(joints),
            'start_frequency': FREQUENCIES[0], 'end_frequency': FREQUENCIES[1],
            'duration': float(self.seconds), 'message': 'joint_state', 'rate': float(self.rate),
            'wait_for_subscribers': subscribers, 'start_delay': SETTLE, 'linger': DRAIN})
        return self._session.start('source', [
            programs / 'trajectory_publisher_node', '__name:=source'])

    def _watch(self, source):
        """Samples the usage from the first joint state to the last, and waits for the end."""
        begin = time.monotonic() + SETTLE
        while source.running():
            self._session.check(may_end=source)
            passed = time.monotonic() - begin
            if 0.5 < passed < self.seconds - 0.5:
                self.usage.sample()
            self._progress('%g Hz: %.0f of %g s' % (
                self.rate, min(max(passed, 0), self.seconds), self.seconds))
            time.sleep(0.5)

    def _published(self, source):
        self._session.processes.remove(source)
        found = re.search(r'published (\d+) messages', source.output())
        if not found:
            raise SessionError('source has failed: %s' % source.output().strip())
        return int(found.group(1))

    def _bus_counts(self, nodes):
        """Messages that left for the recorder, and that the recorder's queues dropped, by topic."""
        sent, dropped = {}, {}
        for node in nodes:
            for topic, connections in self._session.bus_stats('/' + node.name)[0]:
                sent[topic] = sum(connection[3] for connection in connections)
        for topic, connections in self._session.bus_stats(RECORDER)[1]:
            dropped[topic] = sum(connection[3] for connection in connections)
        return sent, dropped

    def _loss(self, topic, sent, dropped):
        first = self.run.first_stamp(self.rate)
        expected = self.joint_states
        if topic.startswith(NODE):
            expected -= self._without_result()
        recorded = self.run.topics[topic]
        # The source has gone, and with it the counts of its connections.
        is_input = topic == INPUT
        return Loss(topic, expected, None if is_input else sent[topic],
                    None if is_input else dropped.get(topic, 0), len(recorded.stamps),
                    recorded.gaps(), recorded.wrong_stamps(first, self.rate))

    def _without_result(self):
        """How many joint states at the end are younger than the lag."""
        newest = round(self.seconds * 1e9)
        return sum(newest - round(k * 1e9 / self.rate) < round(self._lag * 1e9)
                   for k in range(self.joint_states - 1)) + (self._lag > 0)

    def lost_before_node(self):
        return self.joint_states - self.run.count('inverse_dynamics', 'joint states received')

    def lost_in_node(self):
        """Results that were not computed, or did not leave the node."""
        computed = self.run.count('inverse_dynamics', 'samples computed')
        received = self.run.count('inverse_dynamics', 'joint states received')
        return received - self._without_result() - computed + sum(
            computed - loss.sent for loss in self.losses if loss.topic.startswith(NODE))

    def missing(self):
        """Messages that are not in the bag, or not as they must be."""
        return sum(abs(loss.expected - loss.recorded) + loss.stamps for loss in self.losses)

    def behind(self):
        """s from when the last joint state was due to the last record: queues that had filled."""
        last_stamp = self.run.first_stamp(self.rate) + (self.joint_states - 1) * 1e9 / self.rate
        return (self.run.last_record() - last_stamp) * 1e-9
