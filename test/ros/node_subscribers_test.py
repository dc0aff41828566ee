#!/usr/bin/python3
"""Nothing is computed that nobody listens to, and who comes late misses nothing that comes."""
from geometry_msgs.msg import WrenchStamped
import rospy
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from node_under_test import (EPOCH, Node, NodeTest, Polynomials, joint_state, read, run,
                             wait_until)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
# The estimator's rounding on a cubic; see node_joint_states_test.py.
ESTIMATED = 1e-9
STEP = 10000000  # ns
LAG = 5  # samples: ~estimator/lag of 0.05 s
MOTION = Polynomials(shoulder=(0.3, -0.8, 1.1), elbow=(1.0, 0.9, -0.6, 1.3), slide=(0.05, 0.2))
# What diagnostics call the work for each topic alone.
WORK = {
    'effort': (JointState, 'efforts'),
    'reactions': (MultiDOFJointState, '5 reactions in root axes, poses'),
    'reaction/elbow': (WrenchStamped, '1 reactions in child axes'),
    'reaction/_2nd_finger': (WrenchStamped, '1 reactions in child axes'),
}


class Subscribers(NodeTest):
    def setUp(self):
        self.bodies = RigidBodies(ARM)
        self.node = Node(self, ARM)
        self.states = self.node.feed('joint_states', JointState)
        self.sent = 0

    def publish(self, count=1):
        for _ in range(count):
            ns = EPOCH + STEP * self.sent
            self.states.publish(joint_state(ns, *MOTION(ns)[:2]))
            self.sent += 1

    def publish_trajectory(self, publisher):
        publisher.publish(JointTrajectory(joint_names=COORDINATES, points=[
            JointTrajectoryPoint(positions=[0] * 3, velocities=[0] * 3, accelerations=[0] * 3)]))

    def settled(self):
        """Diagnostics from after the node has dealt with everything sent before this call."""
        self.publish()
        return self.node.wait_for_count('joint states received', self.sent)

    def test_nothing_is_computed_for_nobody(self):
        self.node.wait_for_plan()
        self.publish(50)
        values = self.settled()
        self.assertEqual(values['samples computed'], '0')
        self.assertEqual(values['computed'], 'nothing')
        self.assertNotIn('operations a sample', values)
        self.assertFalse([key for key in values if key.startswith('run time')])
        values = self.node.wait_for_count('samples nobody listened for', self.sent - LAG)
        self.assertEqual(values['samples computed'], '0')

    def test_each_topic_alone_costs_only_its_own_work(self):
        computed = 0
        for topic, (kind, work) in WORK.items():
            recorder = self.node.record(topic, kind)
            values = self.node.wait_for_plan(topic)
            self.assertEqual(values['computed'], work)
            self.assertRegex(values['operations a sample'], r'^[1-9]\d* multiplications, ')
            start = self.sent
            self.publish(10)
            # The first topic waits for the lag, the others find it full.
            computed += 10 - (LAG if start == 0 else 0)
            recorder.wait(10 - (LAG if start == 0 else 0))
            values = self.node.wait_for_count('samples computed', computed)
            self.assertEqual(values['samples computed'], str(computed))
            recorder.stop()
            self.assertEqual(self.node.wait_for_plan()['computed'], 'nothing')
            self.publish(10)
            values = self.settled()
            self.assertEqual(values['samples computed'], str(computed), 'after ' + topic)

    def test_topics_together(self):
        self.node.record('effort', JointState)
        self.node.record('reaction/elbow', WrenchStamped)
        self.node.record('reaction/slide', WrenchStamped)
        values = self.node.wait_for_plan('effort', 'reaction/elbow', 'reaction/slide')
        self.assertEqual(values['computed'], 'efforts, 2 reactions in child axes')

    def test_efforts_of_trajectories_do_not_cost_samples(self):
        recorder = self.node.record('joint_trajectory', JointTrajectory)
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.assertEqual(self.node.wait_for_plan('joint_trajectory')['computed'], 'efforts')
        self.publish(20)
        self.assertEqual(self.settled()['samples computed'], '0')
        self.publish_trajectory(trajectories)
        recorder.wait(1)
        self.assertEqual(self.node.wait_for_count('trajectory points computed', 1)
                         ['samples computed'], '0')

    def test_trajectories_are_not_computed_for_nobody(self):
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.node.wait_for_plan()
        for _ in range(3):
            self.publish_trajectory(trajectories)
        # Nor is anything made up for them; but they are looked at.
        trajectories.publish(JointTrajectory(joint_names=COORDINATES, points=[
            JointTrajectoryPoint(positions=[0] * 3, time_from_start=time)
            for time in (rospy.Duration(0), rospy.Duration(1))]))
        trajectories.publish(JointTrajectory(joint_names=COORDINATES))
        values = self.node.wait_for_count('dropped: no points', 1)
        self.assertEqual(values['trajectories received'], '5')
        self.assertEqual(values['trajectory points computed'], '0')
        self.assertEqual(values['dropped'], '1')
        self.assertNotIn('spline', self.node.output())

    def test_late_subscriber_gets_complete_messages_at_once(self):
        self.publish(20)
        values = self.settled()
        self.assertEqual(values['samples computed'], '0')
        efforts = self.node.record('effort', JointState)
        reactions = self.node.record('reactions', MultiDOFJointState)
        wrench = self.node.record('reaction/left_finger', WrenchStamped)
        self.node.wait_for_plan('effort', 'reactions', 'reaction/left_finger')
        # One more joint state is enough: those before were kept.
        self.publish()
        ns = EPOCH + STEP * (self.sent - 1 - LAG)
        for recorder in (efforts, reactions, wrench):
            messages = recorder.wait(1)
            self.assertEqual(messages[0].header.stamp.to_nsec(), ns)
        motion = MOTION(ns)
        self.assertEqual(efforts.messages()[0].name, COORDINATES)
        self.assertEffort(efforts.messages()[0], self.bodies, motion, ESTIMATED)
        self.assertEqual(len(reactions.messages()[0].joint_names), 5)
        self.assertReactions(reactions.messages()[0], self.bodies, motion, ESTIMATED)
        self.assertWrench(wrench.messages()[0], self.bodies, 'left-finger', motion, ESTIMATED)

    def test_partial_messages_that_nobody_listened_to_are_not_counted_in(self):
        def publish(ns, names):
            q, qd, _ = MOTION(ns)
            self.states.publish(joint_state(ns, {name: q[name] for name in names}, qd))
        stamps = [EPOCH + STEP * i for i in range(13)]
        for ns in stamps[:-1]:
            publish(ns, ['elbow'])
            publish(ns, ['shoulder', 'slide'])
        self.node.wait_for_count('samples nobody listened for', 12 - LAG)
        efforts = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort')
        # The first to come leads, as all come as often; a sample of it is enough.
        publish(stamps[-1], ['elbow'])
        publish(stamps[-1], ['shoulder', 'slide'])
        message = efforts.wait(1)[0]
        self.assertEqual(message.header.stamp.to_nsec(), stamps[-1 - LAG])
        self.assertEffort(message, self.bodies, MOTION(stamps[-1 - LAG]), ESTIMATED)

    def test_who_comes_and_goes_does_not_disturb_the_others(self):
        efforts = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort')
        self.publish(14)
        reactions = self.node.record('reactions', MultiDOFJointState)
        # While the plan changes, and after.
        self.publish(20)
        self.node.wait_for_plan('effort', 'reactions')
        self.publish()
        last = EPOCH + STEP * (self.sent - 1 - LAG)
        wait_until(lambda: reactions.wait(1)[-1].header.stamp.to_nsec() == last, 'the last of them')
        for message in reactions.messages():
            self.assertReactions(message, self.bodies, MOTION(message.header.stamp.to_nsec()),
                                 ESTIMATED)
        reactions.stop()
        self.publish(20)
        self.node.wait_for_plan('effort')
        self.publish(5)
        messages = efforts.wait(self.sent - LAG)
        self.assertStamps(messages, [EPOCH + STEP * i for i in range(self.sent - LAG)])
        self.assertNoGaps(messages)
        for message in messages:
            self.assertEffort(message, self.bodies, MOTION(message.header.stamp.to_nsec()),
                              ESTIMATED)


if __name__ == '__main__':
    run(Subscribers)
