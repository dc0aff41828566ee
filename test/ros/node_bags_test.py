#!/usr/bin/python3
"""Bags played to the node and recorded from it, and publishers that come and go."""
import os
import shutil
import tempfile

from geometry_msgs.msg import WrenchStamped
import rosbag
import roslib.packages
import rospy
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory

from node_under_test import (EPOCH, Node, NodeTest, Polynomials, Process, executable, joint_state,
                             read, ros_time, run, trajectory_point, wait_until)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
# The estimator's rounding on a cubic; see node_joint_states_test.py.
ESTIMATED = 1e-9
STEP = 10000000  # ns
LAG = 5  # samples: ~estimator/lag of 0.05 s
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1), elbow=(1.0, 0.9, -0.6, 1.3), slide=(0.05, 0.2))


class Bags(NodeTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)
        self.bodies = RigidBodies(ARM)
        self.node = Node(self, ARM)
        self.topic = self.node.namespace + '/joint_states'
        self.states = self.node.feed('joint_states', JointState)
        self.efforts = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort')

    def write(self, name, stamps):
        """A bag of the motion; returns its path."""
        path = os.path.join(self.folder, name)
        with rosbag.Bag(path, 'w') as bag:
            for ns in stamps:
                bag.write(self.topic, joint_state(ns, *MOTION(ns)[:2]), ros_time(ns))
        return path

    def play(self, path, option):
        # The program itself, not the script around it: signals go straight to it. The node is the
        # only subscriber, so it is the one that is waited for.
        play = roslib.packages.find_node('rosbag', 'play')[0]
        return Process(self, [play, '--quiet', '--wait-for-subscribers', option, path,
                              '__name:=player', '__ns:=' + self.node.namespace])

    def settled(self):
        """Diagnostics from after all that the player has sent has been dealt with."""
        name = self.node.namespace + '/player'
        wait_until(lambda: name not in self.node.connections(self.topic, 'i'),
                   'the node to be done with the player')
        self.states.publish(joint_state(EPOCH, {'lamp': 0.0}))
        return self.node.wait_for_count('joint states of other robots', 1)

    def received(self):
        """How many joint states have come from the player, restarts and gaps."""
        values = self.settled()
        self.assertEqual((values['joint states of other robots'], values['dropped']), ('1', '0'))
        return (int(values['joint states received']) - 1, int(values['restarts']),
                int(values['gaps']))

    def expect_outputs(self, stamps):
        messages = self.efforts.wait(len(stamps))
        self.assertStamps(messages, stamps)
        self.assertNoGaps(messages)
        for message in messages:
            self.assertEffort(message, self.bodies, MOTION(message.header.stamp.to_nsec()),
                              ESTIMATED)

    def test_looped_bag(self):
        # Longer than ~estimator/max_gap, so that time goes back by more than that.
        stamps = [EPOCH + STEP * i for i in range(51)]
        player = self.play(self.write('loop.bag', stamps), '--loop')
        self.node.wait_for_count('restarts', 3)
        player.interrupt()
        player.wait()
        received, restarts, gaps = self.received()
        rounds, rest = divmod(received, len(stamps))
        self.assertGreaterEqual(rounds, 3)
        self.assertEqual((restarts, gaps), (rounds if rest else rounds - 1, 0))
        # Each round costs the lag at its end; the last one may have been cut short.
        expected = rounds * stamps[:-LAG] + stamps[:rest][:-LAG]
        self.assertEqual(len(expected), rounds * (len(stamps) - LAG) + max(0, rest - LAG))
        self.expect_outputs(expected)
        self.assertEqual(self.node.lines('WARN'), [])

    def test_looped_bag_that_is_shorter_than_a_gap(self):
        stamps = [EPOCH + STEP * i for i in range(21)]
        player = self.play(self.write('loop.bag', stamps), '--loop')
        self.node.wait_for_count('restarts', 3)
        player.interrupt()
        player.wait()
        values = self.settled()
        restarts = int(values['restarts'])
        # A round begins anew after a few joint states that could have come late; the results of all
        # rounds are right.
        self.assertEqual(values['gaps'], '0')
        messages = self.efforts.wait(int(values['samples computed']))
        self.assertNoGaps(messages)
        times = [message.header.stamp.to_nsec() for message in messages]
        self.assertLessEqual(set(times), set(stamps))
        starts = [i for i in range(1, len(times)) if times[i] <= times[i - 1]]
        self.assertGreaterEqual(len(starts), restarts - 1)
        for begin, end in zip([0] + starts, starts):
            # At most 10 joint states are taken for late ones, and LAG have no result at the end.
            self.assertGreaterEqual(end - begin, len(stamps) - 10 - LAG)
            self.assertEqual(times[begin:end],
                             stamps[len(stamps) - LAG - (end - begin):len(stamps) - LAG])
        for message in messages:
            self.assertEffort(message, self.bodies, MOTION(message.header.stamp.to_nsec()),
                              ESTIMATED)

    def test_new_publishers_that_go_on_and_one_after_a_gap(self):
        first = [EPOCH + STEP * i for i in range(20)]
        second = [first[-1] + STEP * (i + 1) for i in range(15)]
        third = [second[-1] + 50 * STEP + STEP * i for i in range(12)]
        count = 0
        for number, stamps in enumerate((first, second, third)):
            # Alive until everything has come: a publisher that ends takes its queue with it.
            player = self.play(self.write('%d.bag' % number, stamps), '--keep-alive')
            count += len(stamps)
            self.node.wait_for_count('joint states received', count)
            player.interrupt()
            player.wait()
        # A new process alone changes nothing: the stamps decide.
        self.assertEqual(self.received(), (count, 0, 1))
        self.expect_outputs((first + second + third)[:-LAG])

    def test_trajectory_publisher_started_anew(self):
        parameters = {'joints': COORDINATES, 'amplitudes': [0.1, 0.2, 0.02], 'duration': 0.2,
                      'rate': 100, 'start_delay': 0, 'linger': 1}
        name = self.node.namespace + '/trajectory_publisher'
        rospy.set_param(name, parameters)
        for _ in range(2):
            publisher = Process(self, [executable('trajectory_publisher_node'),
                                       '__ns:=' + self.node.namespace,
                                       '__name:=trajectory_publisher'])
            self.assertEqual(publisher.wait(), 0, publisher.output())
        # 21 samples each, farther apart than max_gap by the time the first stayed on.
        count = 21
        messages = self.efforts.wait(2 * count - LAG)
        stamps = [message.header.stamp.to_nsec() for message in messages]
        for round_stamps in (stamps[:count], stamps[count:]):
            self.assertEqual(round_stamps,
                             [round_stamps[0] + STEP * i for i in range(len(round_stamps))])
        self.assertEqual(len(stamps), 2 * count - LAG)
        self.assertGreater(stamps[count] - stamps[count - 1], 10 ** 9)
        values = self.node.wait_for_count('gaps', 1)
        self.assertEqual((values['gaps'], values['restarts']), ('1', '0'))

    def record(self, name, count, *topics):
        """A recorder that ends by itself with so many messages of each topic; and its bag."""
        path = os.path.join(self.folder, name + '.bag')
        record = roslib.packages.find_node('rosbag', 'record')[0]
        # In small chunks, so that the file tells how far it is.
        recorder = Process(self, [record, '--quiet', '-O', path, '--limit=%d' % count,
                                  '--chunksize=1'] +
                           [self.node.name + '/' + topic for topic in topics] +
                           ['__name:=' + name, '__ns:=' + self.node.namespace])
        for topic in topics:
            wait_until(lambda topic=topic: self.node.namespace + '/' + name in
                       self.node.connections(self.node.name + '/' + topic, 'o'),
                       lambda topic=topic: 'the recorder of %s: %s' % (topic, recorder.output()))
        return recorder, path

    def wait_until_recorded(self, path, recorders, count):
        """Waits until the file has all of so many messages but the last ones.

        rosbag's subscribers hold 100 messages, and lose some when more are under way; the last ones
        may still be in the file's buffer.
        """
        for recorder in recorders:
            recorder.wait(count)

        def written():
            try:
                with open(path + '.active', 'rb') as file:
                    content = file.read()
            except FileNotFoundError:  # it is complete
                return True
            return all(recorder.raw[count - 30] in content for recorder in recorders)
        wait_until(written, 'the recorder')

    def test_recorded_bag_reads_back_as_it_was_published(self):
        live = {'effort': self.efforts}
        for topic, kind in (('reactions', MultiDOFJointState), ('reaction/slide', WrenchStamped),
                            ('joint_trajectory', JointTrajectory)):
            live[topic] = self.node.record(topic, kind)
        streams = [topic for topic in live if topic != 'joint_trajectory']
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        recorder, path = self.record('streams', 500, *streams)
        other_recorder, other_path = self.record('trajectories', 4, 'joint_trajectory')
        self.node.wait_for_plan(*live)
        times = [STEP * i for i in range(50)]
        for i in range(4):
            message = JointTrajectory(joint_names=COORDINATES)
            message.header.stamp = ros_time(EPOCH + i * 10 ** 9)
            message.points = [trajectory_point(ns, COORDINATES, MOTION(EPOCH + ns)) for ns in times]
            trajectories.publish(message)
            self.wait_until_recorded(path, [live[topic] for topic in streams], 50 * (i + 1))
        for i in range(300 + LAG):
            ns = EPOCH + STEP * i
            self.states.publish(joint_state(ns, *MOTION(ns)[:2]))
            if i % 50 == 49:
                self.wait_until_recorded(path, [live[topic] for topic in streams],
                                         200 + i + 1 - LAG)
        for process in (recorder, other_recorder):
            self.assertEqual(process.wait(), 0, process.output())
        recorded = {}
        for bag_path in (path, other_path):
            with rosbag.Bag(bag_path) as bag:
                for topic, (_, raw, *_), _ in bag.read_messages(raw=True):
                    recorded.setdefault(topic, []).append(raw)
        self.assertEqual(set(recorded), {self.node.name + '/' + topic for topic in live})
        for topic, recorder in live.items():
            size = 4 if topic == 'joint_trajectory' else 500
            self.assertNoGaps(recorder.wait(size))
            self.assertEqual(len(recorder.raw), size)
            # Bytes, so that nothing is equal only nearly.
            self.assertTrue(recorded[self.node.name + '/' + topic] == recorder.raw, topic)

    def test_points_played_at_a_rate_are_all_recorded(self):
        # The recorder's queue of 100 is that of half a second, in which it gets a core.
        count = 1200
        self.node = Node(self, ARM, {'trajectory_rate': 200})
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        recorder, path = self.record('points', count, 'effort', 'reactions')
        self.node.wait_for_plan('effort', 'reactions')
        message = JointTrajectory(joint_names=COORDINATES)
        message.header.stamp = ros_time(EPOCH)
        times = [10 ** 6 * i for i in range(count)]
        message.points = [trajectory_point(ns, COORDINATES, MOTION(EPOCH + ns)) for ns in times]
        trajectories.publish(message)
        # All at once, most would not come through the recorder's queue of 100, and it never ended.
        self.assertEqual(recorder.wait(), 0, recorder.output())
        recorded = {}
        with rosbag.Bag(path) as bag:
            for topic, content, _ in bag.read_messages():
                recorded.setdefault(topic, []).append(content)
        self.assertEqual(set(recorded), {self.node.name + '/effort', self.node.name + '/reactions'})
        for messages in recorded.values():
            self.assertStamps(messages, [EPOCH + ns for ns in times])


if __name__ == '__main__':
    run(Bags)
