#!/usr/bin/python3
"""Bags with all that the node subscribes to: inverse_dynamics_offline, which has robot, scene and
parameters from a dump, writes the messages that the node published, to the last bit."""
import math
import os
import shutil
import subprocess
import tempfile

from geometry_msgs.msg import InertiaStamped, Vector3Stamped, WrenchStamped
from nav_msgs.msg import Odometry
import numpy as np
import rosbag
from sensor_msgs.msg import JointState, MultiDOFJointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory

from carried_arm import JOINTS, CarriedArm
import carried_arm
from closed_loops import SLIDER_CRANK, SLIDER_CRANK_SCENE
from node_free_joints_test import BALL, SCENE, attitude, quaternion, wrist
from node_under_test import (EPOCH, Node, NodeTest, executable, joint_state, read, ros_time, run,
                             trajectory_point, wait_until)
from root_messages import (HANGS_AT, HANGS_BY, WITH_UNIT, frame, frames, imu, odometry,
                           root_trajectory, state)

ARM = read('data', 'arm.urdf')
MS = 1000000
TRANSPORT = 700000  # ns, from a stamp to its receipt
RECEIVED = {JointState: 'joint states received', JointTrajectory: 'trajectories received',
            WrenchStamped: 'wrenches received', InertiaStamped: 'payloads and gravity received',
            Vector3Stamped: 'payloads and gravity received'}
RESULTS = {'effort': JointState, 'reactions': MultiDOFJointState}


def waves(i, step=4 * MS):
    """Positions and velocities of the arm at a step."""
    t = i * step / 1e9
    q, qd = {}, {}
    for name, amplitude, rate in (('elbow', 0.7, 3.0), ('shoulder', 0.4, 2.0), ('slide', 0.05, 5.0)):
        q[name] = amplitude * math.sin(rate * t)
        qd[name] = amplitude * rate * math.cos(rate * t)
    return q, qd


def states_of_arm(first, last):
    return [('joint_states', joint_state(EPOCH + 4 * MS * i, *waves(i))) for i in range(first, last)]


def planned(first, count=20, step=10 * MS, parts=3):
    names = ['shoulder', 'elbow', 'slide']
    message = JointTrajectory(joint_names=names)
    message.header.stamp = ros_time(first)
    for i in range(count):
        q, qd = waves(i, step)
        motion = (q, qd, {name: -2 * qd[name] for name in names})
        message.points.append(trajectory_point(step * i, names, motion, parts))
    return message


class RecordedInputs(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def tool(self, *options, code=0):
        done = subprocess.run([executable('inverse_dynamics_offline'), *options],
                              stderr=subprocess.PIPE, encoding='utf-8', check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def send(self, node, blocks):
        """Publishes blocks of messages by topic, each block when the node has the one before, as
        messages of several topics have no order; and writes them to a bag in this order."""
        publishers, counts = {}, {}
        receipt = EPOCH
        with rosbag.Bag(self.path('run.bag'), 'w', chunk_threshold=20000) as bag:
            for block in blocks:
                for name, message in block:
                    if name not in publishers:
                        publishers[name] = node.feed(name, type(message))
                    publishers[name].publish(message)
                    topic = name if name[0] == '/' else node.namespace + '/' + name
                    if hasattr(message, 'header'):
                        receipt = max(receipt, message.header.stamp.to_nsec())
                    bag.write(topic, message, ros_time(receipt + TRANSPORT))
                    key = self.counts.get(name, RECEIVED.get(type(message), 'root messages received'))
                    counts[key] = counts.get(key, 0) + (name != '/tf_static')
                for key, count in counts.items():
                    node.wait_for_count(key, count)

    def expect_as_live(self, robot, parameters, blocks, topics, *options):
        """Each message of each topic is the node's but for its number; returns how many, and what
        the tool says."""
        self.counts = parameters.pop('counts', {})
        node = Node(self, robot, parameters)
        recorders = {topic: node.record(topic, kind) for topic, kind in topics.items()}
        node.wait_for_plan(*topics)
        self.send(node, blocks)
        subprocess.run(['/usr/bin/rosparam', 'dump', self.path('dump.yaml')], check=True,
                       stdout=subprocess.DEVNULL)
        text = self.tool('--rosparam', self.path('dump.yaml'), '--node', node.name, '--motion',
                         self.path('run.bag'), '--output', self.path('results.bag'), *options)
        subprocess.run(['/usr/bin/rosbag', 'check', self.path('results.bag')], check=True,
                       stdout=subprocess.DEVNULL)
        recorded = {topic: [] for topic in topics}
        with rosbag.Bag(self.path('results.bag')) as bag:
            for topic, (_, data, md5, _, _), _ in bag.read_messages(raw=True):
                name = topic[len(node.name) + 1:]
                if name not in topics:
                    continue
                self.assertEqual(md5, topics[name]._md5sum)
                recorded[name].append(data)
        for topic, data in recorded.items():
            raw = recorders[topic].raw
            wait_until(lambda: len(raw) >= len(data), lambda: '%d messages of %s, there are %d; %s' % (
                len(data), topic, len(raw), text))
            self.assertEqual(len(raw), len(data), topic + text)
            for i, (live, offline) in enumerate(zip(raw, data)):
                self.assertEqual(live[4:], offline[4:], 'message %d of %s' % (i, topic))
        self.node = node
        return {topic: len(data) for topic, data in recorded.items()}, text

    def carried(self, source, blocks, robot=carried_arm.ARM, scene=None, **root):
        counts, text = self.expect_as_live(
            robot, {'scene': dict({'root': 'moving', 'reactions': ['ground']}, **(scene or {})),
                    'root': dict({'source': source}, **root)}, blocks,
            dict(RESULTS, effort_deviation=JointState), '--deviations')
        self.assertEqual(counts['effort'], counts['reactions'])
        return counts['effort'], text

    def blocks_of_root(self, topic, make, until=100):
        """The root 100 ms ahead of the joints, at another rate."""
        arm = CarriedArm()
        for k in range(0, until, 25):
            yield [(topic, make(arm, EPOCH + ns * 10 * MS)) for ns in range(k + 10 * (k > 0), k + 35)]
            yield [('joint_states', joint_state(EPOCH + 4 * MS * i + 77, *arm.joints(
                EPOCH + 4 * MS * i + 77)[:2])) for i in range(k * 5 // 2, (k + 25) * 5 // 2)]

    def test_root_by_odometry(self):
        count, text = self.carried('odometry', self.blocks_of_root('odom', odometry))
        self.assertGreater(count, 200)
        self.assertIn("/odom'", text)

    def test_wrench_in_the_inertial_frame(self):
        def push(k):
            message = WrenchStamped()
            message.header.stamp = ros_time(EPOCH + 40 * MS * k)
            message.header.frame_id = 'odom'
            message.wrench.force.x, message.wrench.torque.z = 3.0 * k, -0.1 * k
            return message
        blocks = [[('inverse_dynamics/wrench/push', push(k)) for k in range(30)],
                  *self.blocks_of_root('odom', odometry)]
        count, text = self.carried('odometry', blocks, scene={'applied_wrenches': [
            {'name': 'push', 'link': carried_arm.ROOT, 'live': True}]})
        self.assertGreater(count, 200)
        self.assertNotIn('unknown frame', text)

    def test_root_by_states_and_bad_ones(self):
        arm = CarriedArm()
        bad = state(arm, EPOCH)
        bad.transforms[1].rotation.w = math.nan
        blocks = list(self.blocks_of_root('multi_dof_joint_states', state))
        blocks.insert(2, [('multi_dof_joint_states', bad)])
        blocks.append([('joint_states', joint_state(EPOCH + 4 * MS * i, *arm.joints(
            EPOCH + 4 * MS * i)[:2])) for i in range(250, 300)])
        count, text = self.carried('states', blocks, timeout=0.05)
        self.assertGreater(count, 200)
        self.assertIn('1 message dropped', text)
        self.assertRegex(text, r'\d+ results? dropped \(no root motion\), first message \d+: '
                               r'/robot_\d+/multi_dof_joint_states tells how the root link moves')

    def test_root_by_imu(self):
        count, _ = self.carried('imu', self.blocks_of_root('imu', imu), robot=WITH_UNIT)
        self.assertGreater(count, 150)

    def test_root_by_tf(self):
        fixed = TFMessage([frame('left/mount', 'base', 0, HANGS_AT, HANGS_BY)])
        blocks = [[('/tf_static', fixed)], *self.blocks_of_root('/tf', frames)]
        count, _ = self.carried('tf', blocks)
        self.assertGreater(count, 150)

    def test_root_by_trajectory_with_trajectory_of_joints(self):
        arm = CarriedArm()
        stamps = [EPOCH + 50 * MS * i for i in range(21)]
        plan = JointTrajectory(joint_names=JOINTS)
        plan.header.stamp = ros_time(stamps[0])
        plan.points = [trajectory_point(ns - stamps[0], JOINTS, arm.joints(ns)) for ns in stamps]
        counts, _ = self.expect_as_live(
            carried_arm.ARM, {'scene': {'root': 'moving', 'reactions': ['ground']},
                              'root': {'source': 'trajectory'}, 'trajectory_sampling': 100},
            [[('multi_dof_joint_trajectory', root_trajectory(arm, stamps))],
             [('joint_trajectory', plan)]],
            dict(RESULTS, joint_trajectory=JointTrajectory))
        self.assertEqual(counts, {'effort': 101, 'reactions': 101, 'joint_trajectory': 1})

    def test_trajectories_between_joint_states(self):
        bad = planned(EPOCH)
        bad.points[3].positions = bad.points[3].positions[:2]
        late = planned(0)  # from its receipt on, which the bag has
        blocks = [states_of_arm(0, 100), [('joint_trajectory', planned(EPOCH + 5 * MS))],
                  states_of_arm(100, 200), [('joint_trajectory', bad)],
                  [('joint_trajectory', planned(EPOCH + 9 * MS, parts=1))],
                  states_of_arm(200, 250)]
        counts, text = self.expect_as_live(
            ARM, {'scene': {'reactions': ['shoulder', 'ground']}}, blocks,
            dict(RESULTS, joint_trajectory=JointTrajectory, motion=JointTrajectory))
        self.assertEqual(counts['joint_trajectory'], 2)
        self.assertGreater(counts['effort'], 200 + 40)
        self.assertIn('1 message dropped (array length)', text)
        # Alone, and with a stamp of zero: from its receipt on.
        with rosbag.Bag(self.path('run.bag'), 'w') as bag:
            bag.write('/arm/plan', late, ros_time(EPOCH + 3))
        text = self.tool('--rosparam', self.path('dump.yaml'), '--node', self.node.name, '--remap',
                         'joint_trajectory:=/arm/plan', '--motion', self.path('run.bag'),
                         '--output', self.path('results.bag'))
        with rosbag.Bag(self.path('results.bag')) as bag:
            stamps = [m.message.header.stamp.to_nsec()
                      for m in bag.read_messages(self.node.name + '/effort')]
        self.assertEqual(stamps, [EPOCH + 3 + 10 * MS * i for i in range(20)])

    def test_closed_loop_with_trajectory(self):
        def crank(i):
            return 1.5 * math.sin(2 * i * 4e-3 + 0.3), 3 * math.cos(2 * i * 4e-3 + 0.3)
        plan = JointTrajectory(joint_names=['crank_joint'])
        plan.header.stamp = ros_time(EPOCH + 11)
        plan.points = [trajectory_point(4 * MS * i, ['crank_joint'],
                                        [{'crank_joint': value} for value in crank(i)], 2)
                       for i in range(60)]
        states = [('joint_states', joint_state(EPOCH + 4 * MS * i, *(
            {'crank_joint': value} for value in crank(i)))) for i in range(200)]
        counts, _ = self.expect_as_live(
            SLIDER_CRANK, {'scene': SLIDER_CRANK_SCENE},
            [states[:100], [('joint_trajectory', plan)], states[100:]],
            dict(RESULTS, joint_trajectory=JointTrajectory))
        self.assertGreater(counts['effort'], 60 + 180)

    def test_live_wrench_payload_and_gravity(self):
        def push(k):
            message = WrenchStamped()
            message.header.stamp = ros_time(EPOCH + 10 * MS * k + 5)
            message.header.frame_id = 'forearm' if k % 2 else 'hand'
            message.wrench.force.x, message.wrench.torque.z = 3.0 * k, -0.1 * k
            return message
        load = InertiaStamped()
        load.header.frame_id = 'hand'
        load.inertia.m, load.inertia.com.z = 1.5, 0.1
        down = Vector3Stamped()
        down.header.frame_id = 'stand'
        down.vector.x, down.vector.z = 1.0, -9.0
        lost = push(0)
        lost.header.frame_id = 'lamp'
        private = 'inverse_dynamics/'
        blocks = [[(private + 'wrench/push', push(k)) for k in range(40)], states_of_arm(0, 80),
                  [(private + 'payload/hand', load)], states_of_arm(80, 120),
                  [(private + 'gravity', down)], states_of_arm(120, 140),
                  [(private + 'wrench/push', lost)], states_of_arm(140, 180)]
        counts, text = self.expect_as_live(
            ARM, {'scene': {'reactions': ['shoulder', 'ground'], 'applied_wrenches': [
                {'name': 'push', 'link': 'hand', 'live': True}]}, 'wrench_timeout': 0.03},
            blocks, RESULTS)
        # Then the wrench is stale.
        self.assertGreater(counts['effort'], 90)
        self.assertLess(counts['effort'], 115)
        self.assertIn("link 'hand' carries 1.5 kg", text)
        self.assertIn('gravity is [1, 0, -9] m/s^2', text)
        self.assertIn('(unknown frame)', text)
        self.assertRegex(text, r'results dropped \(no wrench\), first message \d+: '
                               r'/robot_\d+/inverse_dynamics/wrench/push is known from stamp')

    def test_joint_that_turns_freely(self):
        def ball(k):
            message = MultiDOFJointState(joint_names=['ball'])
            message.header.stamp = ros_time(EPOCH + 5 * MS * k)
            message.transforms = [carried_arm.Transform(
                rotation=quaternion(attitude(5e-3 * k), 1 if k % 3 else -1))]
            return message
        blocks = []
        for k in range(0, 200, 8):
            blocks.append([('multi_dof_joint_states', ball(j)) for j in range(k, k + 8)])
            blocks.append([('joint_states', joint_state(
                EPOCH + 2 * MS * i, *({'wrist': value} for value in wrist(2e-3 * i)[:2])))
                for i in range(k * 5 // 2, (k + 8) * 5 // 2)])
        counts, _ = self.expect_as_live(
            BALL, {'scene': SCENE, 'counts': {
                'multi_dof_joint_states': 'messages of joints that turn freely received'}},
            blocks, {'effort': JointState})
        self.assertGreater(counts['effort'], 400)

    def test_residuals(self):
        noise = np.random.default_rng(4)
        messages = states_of_arm(0, 400)
        for i, (_, message) in enumerate(messages):
            message.effort = list(5 * noise.normal(size=len(message.name)))
            if i % 20 == 7:
                message.effort[1] = math.nan
            if 200 <= i < 230:
                message.effort = []
        counts, text = self.expect_as_live(
            ARM, {'scene': {'reactions': 'none'}, 'external_effort': {'gain': 40}}, [messages],
            {'effort': JointState, 'residual': JointState, 'external_effort': JointState},
            '--residuals')
        self.assertGreater(counts['residual'], 350)
        self.assertGreater(counts['external_effort'], 350)
        self.assertNotIn('dropped', text)

    def test_description_and_scene_of_the_bag_itself(self):
        self.expect_as_live(ARM, {'scene': {'reactions': ['shoulder'], 'gravity': [0, 3, -9]}},
                            [states_of_arm(0, 100)], RESULTS)
        with rosbag.Bag(self.path('run.bag'), 'a') as bag:
            bag.write('/robot_description', String(ARM), ros_time(EPOCH))
            bag.write(self.node.name + '/scene',
                      String('{reactions: [shoulder], gravity: [0, 3, -9]}'), ros_time(EPOCH))
        motion = ['--node', self.node.name, '--motion']
        text = self.tool(*motion, self.path('run.bag'), '--output', self.path('own.bag'),
                         '--copy-input')
        self.assertIn("the description is that of '/robot_description', the scene that of", text)

        def efforts(name):
            with rosbag.Bag(self.path(name)) as bag:
                return [m.message for m in bag.read_messages(self.node.name + '/effort')]
        self.assertEqual(efforts('own.bag'), efforts('results.bag'))
        # What --copy-input kept is a description, too.
        self.tool('--node', self.node.name, '--topic', self.node.namespace + '/joint_states',
                  '--motion', self.path('own.bag'), '--output', self.path('own.csv'))
        self.tool('--rosparam', self.path('dump.yaml'), *motion, self.path('run.bag'), '--output',
                  self.path('dumped.csv'))
        with open(self.path('own.csv'), 'rb') as one, open(self.path('dumped.csv'), 'rb') as other:
            self.assertEqual(one.read(), other.read())

    def test_what_is_missing_or_wrong_is_one_line(self):
        with rosbag.Bag(self.path('run.bag'), 'w') as bag:
            for _, message in states_of_arm(0, 60):
                bag.write('/joint_states', message, message.header.stamp)
            bag.write('/robot/odom', Odometry(), ros_time(EPOCH))
            bag.write('/imu', WrenchStamped(), ros_time(EPOCH))
        for name, text in (
                ('dump.yaml', 'inverse_dynamics: {scene: {root: moving}, root: {source: odometry}}'),
                ('lag.yaml', 'inverse_dynamics: {estimator: {lagg: 1}}'),
                ('robot.urdf', ARM), ('moving.yaml', 'root: moving')):
            with open(self.path(name), 'w', encoding='utf-8') as file:
                file.write(text)
        common = ['--urdf', self.path('robot.urdf'), '--motion', self.path('run.bag'), '--output',
                  self.path('results.bag')]
        dump = ['--rosparam', self.path('dump.yaml')]
        moving = ['--scene', self.path('moving.yaml')]
        for options, code, wanted in (
                (dump, 1, "run.bag: has no topic '/odom' of nav_msgs/Odometry, which tells how the "
                          "root link moves; '/robot/odom' would be read by --remap odom:=TOPIC"),
                (moving, 1, 'moving.yaml: root: moving: ~root/source does not say'),
                ([*moving, '--root-source', 'imu'], 1,
                 "run.bag: topic '/imu' is of 'geometry_msgs/WrenchStamped', and imu is read from "
                 'sensor_msgs/Imu'),
                ([*moving, '--root-source', 'wheel'], 1, "'wheel' is none of odometry"),
                (['--root-source', 'odometry'], 1, "the scene does not say 'root: moving'"),
                (['--rosparam', self.path('lag.yaml')], 1,
                 'lag.yaml: unknown parameter ~estimator/lagg (did you mean ~estimator/lag?)'),
                (['--remap', 'odometry:=/x'], 2, "--remap: 'odometry' is no topic that is read here"),
                (['--remap', 'joint_states:=/x'], 1, "has no topic '/x'"),
                (['--remap', 'gravity:=/down'], 1,
                 "has no topic '/down' of geometry_msgs/Vector3Stamped")):
            text = self.tool(*common, *options, code=code)
            self.assertIn(wanted, text)
            self.assertEqual(text.count('\n'), 1 if code == 1 else 2, text)
            self.assertFalse(os.path.exists(self.path('results.bag')))

    def test_bytes_that_are_no_message(self):
        """Lengths in them must not become memory."""
        with rosbag.Bag(self.path('run.bag'), 'w') as bag:
            for _, message in states_of_arm(0, 60):
                bag.write('/joint_states', message, message.header.stamp)
            raw = b'\xff' * 200
            for name, kind in (('joint_trajectory', JointTrajectory), ('odom', Odometry)):
                bag.write('/' + name, (kind._type, raw, kind._md5sum, kind), ros_time(EPOCH), raw=True)
        with open(self.path('robot.urdf'), 'w', encoding='utf-8') as file:
            file.write(ARM)
        text = self.tool('--urdf', self.path('robot.urdf'), '--motion', self.path('run.bag'),
                         '--output', self.path('results.bag'))
        self.assertIn('/joint_trajectory: 1 message dropped (internal), first message 1: its bytes '
                      'are not those of a trajectory_msgs/JointTrajectory', text)


if __name__ == '__main__':
    run(RecordedInputs)
