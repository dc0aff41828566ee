#!/usr/bin/python3
"""Bags that inverse_dynamics_offline writes: the node's messages of the same joint states, to the
last bit, in bags that rosbag takes."""
import math
import os
import random
import shutil
import subprocess
import tempfile

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
import rosbag
import rospy
from sensor_msgs.msg import JointState, MultiDOFJointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory
import yaml

from closed_loops import REACTIONS, SLIDER_CRANK, SLIDER_CRANK_SCENE
from node_under_test import (EPOCH, Node, NodeTest, Recorder, executable, joint_state, read, ros_time,
                             run, wait_until)

ARM = read('data', 'arm.urdf')
STEP = 4000000  # ns
TRANSPORT = 700000  # ns, from a stamp to its receipt


def swing(i, amplitude, rate, phase=0.0):
    """Position and velocity at a step."""
    t = i * STEP / 1e9
    return amplitude * math.sin(rate * t + phase), amplitude * rate * math.cos(rate * t + phase)


class Recordings(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name, content=None):
        path = os.path.join(self.folder, name)
        if content is not None:
            with open(path, 'w', encoding='utf-8') as file:
                file.write(content)
        return path

    def compute(self, robot, scene, messages, *options):
        """Bags with these messages and of their results; the lines of the tool."""
        with rosbag.Bag(self.path('run.bag'), 'w', chunk_threshold=20000) as bag:
            for message in messages:
                stamp = max(message.header.stamp.to_nsec(), EPOCH)
                bag.write('/joint_states', message, ros_time(stamp + TRANSPORT))
                if message.header.seq % 10 == 0:
                    bag.write('/note', String(data='of no use'), ros_time(stamp + TRANSPORT))
        arguments = [executable('inverse_dynamics_offline'),
                     '--urdf', self.path('robot.urdf', robot),
                     '--scene', self.path('scene.yaml', yaml.safe_dump(scene)),
                     '--motion', self.path('run.bag'), '--output', self.path('results.bag'),
                     *options]
        done = subprocess.run(arguments, stderr=subprocess.PIPE, encoding='utf-8', check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        subprocess.run(['/usr/bin/rosbag', 'check', self.path('results.bag')], check=True,
                       stdout=subprocess.DEVNULL)
        return done.stderr

    def expect_as_live(self, robot, scene, messages, topics, **parameters):
        """Each message of each topic is the node's but for its number; returns how many."""
        node = Node(self, robot, dict(parameters, scene=scene))
        live_frames = Recorder('/tf_static', TFMessage)  # latched
        self.addCleanup(live_frames.stop)
        states = node.feed('joint_states', JointState)
        recorders = {topic: node.record(topic, kind) for topic, kind in topics.items()}
        node.wait_for_plan(*topics)
        for message in messages:
            states.publish(message)
        node.wait_for_count('joint states received', len(messages))
        self.compute(robot, scene, messages, '--deviations')
        recorded, frames = {topic: [] for topic in topics}, []
        with rosbag.Bag(self.path('results.bag')) as bag:
            for topic, (kind, data, md5, _, _), time in bag.read_messages(raw=True):
                if topic == '/tf_static':
                    frames.append(data)
                    continue
                name = topic[len('/inverse_dynamics/'):]
                self.assertIn(name, topics, topic)
                self.assertEqual((kind, md5), (topics[name]._type, topics[name]._md5sum))
                recorded[name].append(data)
        for topic, data in recorded.items():
            raw = recorders[topic].raw
            wait_until(lambda: len(raw) >= len(data), lambda: '%d messages of %s, there are %d' % (
                len(data), topic, len(raw)))
            self.assertEqual(len(raw), len(data), topic)
            for i, (live, offline) in enumerate(zip(raw, data)):
                self.assertEqual(live[4:], offline[4:], 'message %d of %s' % (i, topic))
        wait_until(lambda: len(live_frames.raw) >= len(frames), 'frames')
        self.assertEqual(live_frames.raw, frames)
        return {topic: len(data) for topic, data in recorded.items()}

    def test_arm_with_all_that_drivers_send(self):
        noise = random.Random(1)
        messages = []
        for i in range(1200):
            if 500 <= i < 600:
                continue  # longer than the longest gap
            q, qd = {}, {}
            for name, amplitude, rate in (('elbow', 0.7, 3.0), ('shoulder', 0.4, 2.0),
                                          ('slide', 0.05, 5.0)):
                position, qd[name] = swing(i, amplitude, rate)
                q[name] = position + noise.gauss(0, 1e-5)
            if i % 3 == 1:  # in another order, and with a joint that the arm does not have
                q = {'lamp': 1.0, **dict(reversed(q.items()))}
                qd['lamp'] = 0.0
            elif i % 7 == 3:  # in two parts
                messages.append(joint_state(EPOCH + STEP * i, {'slide': q.pop('slide')}))
            if i % 50 == 20:
                q['shoulder'] = math.nan
            if i % 50 == 30:
                qd['elbow'] = math.nan
            messages.append(joint_state(EPOCH + STEP * i, q, qd))
            if i % 50 == 40:
                messages.append(messages[-1])  # once more
            if i % 50 == 45:
                messages[-2:] = reversed(messages[-2:])  # late
            if i % 100 == 50:
                messages.append(joint_state(EPOCH + STEP * i, {'lamp': 0.5}))
                messages.append(joint_state(0, q))
        topics = {'effort': JointState, 'motion': JointTrajectory, 'effort_deviation': JointState,
                  'effort_tolerance': JointState, 'reactions': MultiDOFJointState,
                  'reaction/shoulder': WrenchStamped, 'reaction/ground': WrenchStamped}
        scene = {'reactions': ['shoulder', 'ground'], 'tolerances': {'mass': 0.02}}
        counts = self.expect_as_live(ARM, scene, messages, topics)
        self.assertGreater(counts['effort'], 900)
        self.assertEqual(set(counts.values()), {counts['effort']})

    def test_closed_loop(self):
        messages = [joint_state(EPOCH + STEP * i, *({'crank_joint': value} for value in
                                                    swing(i, 1.5, 2.0, 0.3)))
                    for i in range(700)]
        topics = {'effort': JointState, 'motion': JointTrajectory, 'reactions': MultiDOFJointState,
                  'effort_deviation': JointState, 'determinacy': DiagnosticArray}
        topics.update({'reaction/' + name: WrenchStamped for name in REACTIONS})
        counts = self.expect_as_live(SLIDER_CRANK, SLIDER_CRANK_SCENE, messages, topics)
        self.assertGreater(counts['effort'], 600)

    def test_input_is_copied_and_results_carry_their_stamps(self):
        messages = [joint_state(EPOCH + STEP * i, *({'crank_joint': value} for value in
                                                    swing(i, 1.5, 2.0)))
                    for i in range(200)]
        for i, message in enumerate(messages):
            message.header.seq = i
        text = self.compute(SLIDER_CRANK, SLIDER_CRANK_SCENE, messages, '--copy-input', '--node',
                            '/cell/id')
        self.assertIn('200 messages', text)
        with rosbag.Bag(self.path('run.bag')) as before, \
                rosbag.Bag(self.path('results.bag')) as after:
            originals = list(before.read_messages(raw=True))
            copies = list(after.read_messages(['/joint_states', '/note'], raw=True))
            self.assertEqual(len(originals), 220)
            self.assertEqual([(m.topic, m.timestamp, m.message[0], m.message[1])
                              for m in sorted(originals)],
                             [(m.topic, m.timestamp, m.message[0], m.message[1])
                              for m in sorted(copies)])
            efforts = list(after.read_messages('/cell/id/effort'))
            received = {m.timestamp for m in originals}
            stamps = [m.message.header.stamp.to_nsec() for m in efforts]
            self.assertEqual(stamps, [EPOCH + STEP * i for i in range(len(stamps))])
            self.assertGreater(len(stamps), 180)
            self.assertLessEqual({m.timestamp for m in efforts}, received)
            self.assertEqual([m.message.header.seq for m in efforts], list(range(len(stamps))))
            times = [m.timestamp.to_sec() for m in after.read_messages(raw=True)]
            self.assertEqual((after.get_start_time(), after.get_end_time()),
                             (min(times), max(times)))
            connections = after.get_type_and_topic_info()[1]
            self.assertEqual(connections['/cell/id/reaction/wrist_pin'].msg_type,
                             'geometry_msgs/WrenchStamped')

    def test_rosbag_plays_what_was_written(self):
        messages = [joint_state(EPOCH + STEP * i, *({'crank_joint': value} for value in
                                                    swing(i, 1.5, 2.0)))
                    for i in range(100)]
        self.compute(SLIDER_CRANK, SLIDER_CRANK_SCENE, messages)
        heard = []
        subscriber = rospy.Subscriber('/inverse_dynamics/effort', JointState, heard.append)
        self.addCleanup(subscriber.unregister)
        subprocess.run(['/usr/bin/rosbag', 'play', '--quiet', '--wait-for-subscribers',
                        '--topics', '/inverse_dynamics/effort', '--bags',
                        self.path('results.bag')], check=True, stdout=subprocess.DEVNULL)
        with rosbag.Bag(self.path('results.bag')) as bag:
            written = [m.message for m in bag.read_messages('/inverse_dynamics/effort')]
        wait_until(lambda: len(heard) >= len(written), 'all efforts to be played')
        self.assertEqual([(m.header.stamp, m.name, m.position, m.effort) for m in heard],
                         [(m.header.stamp, m.name, m.position, m.effort) for m in written])


if __name__ == '__main__':
    run(Recordings)
