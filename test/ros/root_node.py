"""The node with an arm whose root moves, and the oracle, for its ROS tests."""
import math

from nav_msgs.msg import Odometry
import numpy as np
from sensor_msgs.msg import Imu, JointState, MultiDOFJointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, MultiDOFJointTrajectory

from carried_arm import ARM, JOINTS, CarriedArm
from node_under_test import EPOCH, Node, NodeTest, joint_state, ros_time, trajectory_point, vector

MS = 1000000


class RootTest(NodeTest):
    """With a source of the root's motion, the joints at 500 Hz and exact."""

    SECONDS = 4

    def start(self, source, arm=None, parameters=None, robot=ARM):
        self.arm = arm or CarriedArm()
        self.node = Node(self, robot, dict({
            'scene': {'root': 'moving', 'reactions': ['ground']},
            'root': {'source': source}}, **(parameters or {})))
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.states = self.node.feed('joint_states', JointState)
        self.efforts = self.node.record('effort', JointState)
        self.reactions = self.node.record('reactions', MultiDOFJointState)
        self.node.wait_for_plan('effort', 'reactions')
        self.sent = 0
        topic, kind = {'odometry': ('odom', Odometry),
                       'trajectory': ('multi_dof_joint_trajectory', MultiDOFJointTrajectory),
                       'states': ('multi_dof_joint_states', MultiDOFJointState),
                       'tf': ('/tf', TFMessage),
                       'imu': ('imu', Imu)}[source]
        self.topic = topic if topic[0] == '/' else self.node.namespace + '/' + topic
        self.roots = self.node.feed(topic, kind)

    def send(self, *messages):
        """Sends messages of the root and waits until the node has them."""
        for message in messages:
            self.roots.publish(message)
        self.sent += len(messages)
        return self.node.wait_for_count('root messages received', self.sent)

    def joint_trajectory(self, stamps):
        message = JointTrajectory(joint_names=JOINTS)
        message.header.stamp = ros_time(stamps[0])
        message.points = [trajectory_point(ns - stamps[0], JOINTS, self.arm.joints(ns))
                          for ns in stamps]
        return message

    def play(self, stamps):
        self.trajectories.publish(self.joint_trajectory(stamps))

    def worst(self, count):
        """Largest errors of efforts, N m, and of ground's wrench, over some tens of messages."""
        worst = [0, 0]
        every = max(1, count // 50)  # the oracle takes its time
        for message in self.efforts.wait(count)[::every]:
            wanted = self.arm.efforts(message.header.stamp.to_nsec())
            self.assertEqual(message.name, JOINTS)
            worst[0] = max(worst[0], max(np.abs(np.array(message.effort) - wanted)))
        for message in self.reactions.wait(count)[::every]:
            self.assertEqual(message.joint_names, ['ground'])
            wanted = np.concatenate(self.arm.ground(message.header.stamp.to_nsec()))
            found = vector(message.wrench[0].force) + vector(message.wrench[0].torque)
            worst[1] = max(worst[1], max(np.abs(found - wanted)))
        self.assertTrue(all(math.isfinite(value) for value in worst))
        return worst

    def follow(self, roots, rate):
        """Sends what roots(ns) makes at a rate, Hz, and joint states up to the end."""
        stamps = [EPOCH + int(i * 1e9 / rate) for i in range(int(self.SECONDS * rate) + 1)]
        for ns in stamps:
            self.roots.publish(roots(ns))
        self.node.wait_for_count('root messages received', len(stamps))
        # Until the noises are found from some tenths of a second, accelerations are less exact.
        first, last = EPOCH + 2000 * MS, EPOCH + self.SECONDS * 1000 * MS
        for ns in range(first, last + 1, 2 * MS):
            self.states.publish(joint_state(ns, *self.arm.joints(ns)[:2]))
        # The lag of 0.05 s is 25 samples, and the first four are waited for.
        return self.worst((last - first) // (2 * MS) - 27)
