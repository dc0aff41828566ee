#!/usr/bin/python3
"""What the output messages hold: names, frames, topics, and what the scene asks for."""
import socket

from geometry_msgs.msg import WrenchStamped
from numpy import cross
import rosgraph
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory

from node_under_test import (EPOCH, Node, NodeTest, joint_state, read, ros_time, run,
                             trajectory_point, vector)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
# The oracle's rounding.
EXACT = 1e-12
STATE = (dict(shoulder=0.7, elbow=-1.3, slide=0.11), dict(shoulder=1.2, elbow=-0.8, slide=0.3),
         dict(shoulder=-2.0, elbow=3.0, slide=0.9))
ZERO = dict.fromkeys(COORDINATES, 0)


class Outputs(NodeTest):
    def start(self, *topics, gravity=(0, 0, -9.81), **parameters):
        """Starts the node; afterwards results() has the one message of each topic for STATE."""
        kinds = {'effort': JointState, 'effort_deviation': JointState,
                 'effort_tolerance': JointState, 'reactions': MultiDOFJointState}
        self.bodies = RigidBodies(ARM, gravity)
        self.node = Node(self, ARM, parameters)
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        recorders = [self.node.record(topic, kinds.get(topic, WrenchStamped)) for topic in topics]
        self.node.wait_for_plan(*topics)
        message = JointTrajectory(joint_names=COORDINATES)
        message.header.stamp = ros_time(EPOCH)
        message.points = [trajectory_point(0, COORDINATES, STATE)]
        trajectories.publish(message)
        return [recorder.wait(1)[0] for recorder in recorders]

    def advertised(self):
        """Topics of the node by type, without ROS's own."""
        master = rosgraph.Master('/test')
        types = dict(master.getTopicTypes())
        publishers, _, _ = master.getSystemState()
        return {topic: types[topic] for topic, nodes in publishers
                if self.node.name in nodes and topic not in ('/rosout', '/diagnostics')}

    def test_frames_have_the_prefix(self):
        effort, reactions, elbow = self.start('effort', 'reactions', 'reaction/elbow',
                                              frame_prefix='left/')
        self.assertEqual(effort.header.frame_id, 'left/stand')
        self.assertEqual(reactions.header.frame_id, 'left/stand')
        self.assertEqual(elbow.header.frame_id, 'left/forearm')

    def test_topics_of_names_that_no_topic_can_have(self):
        left, right, slide = self.start('reaction/left_finger', 'reaction/_2nd_finger',
                                        'reaction/slide')
        for message, joint, link in ((left, 'left-finger', 'left_pad'),
                                     (right, '2nd.finger', 'right_pad'), (slide, 'slide', 'hand')):
            self.assertEqual(message.header.frame_id, link)
            self.assertEqual(message.header.stamp.to_nsec(), EPOCH)
            self.assertWrench(message, self.bodies, joint, STATE, EXACT)
        self.assertEqual(self.advertised(), {self.node.name + '/' + topic: kind for topic, kind in (
            ('effort', 'sensor_msgs/JointState'),
            ('motion', 'trajectory_msgs/JointTrajectory'),
            ('effort_deviation', 'sensor_msgs/JointState'),
            ('residual', 'sensor_msgs/JointState'),
            ('external_effort', 'sensor_msgs/JointState'),
            ('reactions', 'sensor_msgs/MultiDOFJointState'),
            ('markers', 'visualization_msgs/MarkerArray'),
            ('joint_trajectory', 'trajectory_msgs/JointTrajectory'),
            ('reaction/shoulder', 'geometry_msgs/WrenchStamped'),
            ('reaction/elbow', 'geometry_msgs/WrenchStamped'),
            ('reaction/slide', 'geometry_msgs/WrenchStamped'),
            ('reaction/_2nd_finger', 'geometry_msgs/WrenchStamped'),
            ('reaction/left_finger', 'geometry_msgs/WrenchStamped'))})

    def test_ground_and_fixed_joints_on_request(self):
        reactions, ground, flange, effort = self.start(
            'reactions', 'reaction/ground', 'reaction/flange', 'effort',
            scene={'reactions': ['flange', 'ground', 'elbow']})
        # Ground first, then from the root outwards, in whatever order they were asked for.
        self.assertEqual(reactions.joint_names, ['ground', 'elbow', 'flange'])
        self.assertReactions(reactions, self.bodies, STATE, EXACT)
        self.assertEqual(ground.header.frame_id, 'stand')
        self.assertWrench(ground, self.bodies, 'ground', STATE, EXACT)
        self.assertEqual(flange.header.frame_id, 'tool')
        self.assertWrench(flange, self.bodies, 'flange', STATE, EXACT)
        self.assertEffort(effort, self.bodies, STATE, EXACT)
        self.assertNotIn(self.node.name + '/reaction/shoulder', self.advertised())

    def test_tolerances_of_the_scene(self):
        effort, tolerance = self.start('effort', 'effort_tolerance',
                                       scene={'tolerances': {'mass': 0.01, 'inertia': 0.1}})
        self.assertEqual(tolerance.name, COORDINATES)
        self.assertEqual(tolerance.header.stamp, effort.header.stamp)
        self.assertEqual(tolerance.header.frame_id, effort.header.frame_id)
        self.assertEqual((len(tolerance.position), len(tolerance.velocity)), (0, 0))
        self.assertTrue(all(deviation > 0 for deviation in tolerance.effort))

    def test_twists_on_request(self):
        reactions, = self.start('reactions', twist=True)
        self.assertEqual(len(reactions.twist), len(reactions.joint_names))
        for name, twist in zip(reactions.joint_names, reactions.twist):
            expected = self.bodies.reaction(name, *STATE)
            self.assertClose(vector(twist.linear), expected.linear, EXACT, 'velocity of ' + name)
            self.assertClose(vector(twist.angular), expected.angular, EXACT,
                             'angular velocity of ' + name)

    def test_mimic_joints_have_reactions_but_no_effort(self):
        effort, reactions = self.start('effort', 'reactions')
        self.assertEqual(effort.name, COORDINATES)
        # The oracle adds the shares of the joints that mimic them.
        self.assertEffort(effort, self.bodies, STATE, EXACT)
        self.assertEqual(reactions.joint_names, COORDINATES + ['2nd.finger', 'left-finger'])
        self.assertReactions(reactions, self.bodies, STATE, EXACT)
        self.assertEqual(reactions.twist, [])

    def test_gravity_and_applied_wrenches_of_the_scene(self):
        # rosparam turns numbers such as 1e1 into text.
        scene = {'gravity': [1, '-2e0', 3.5], 'applied_wrenches': [
            {'link': 'tool', 'at': [0.1, 0, -0.2], 'force': ['1e1', 2, 3], 'torque': [0, 1, 2]},
            {'link': 'forearm', 'axes': 'root', 'force': [-4, 0, 5]}]}
        effort, reactions = self.start('effort', 'reactions', gravity=(1, -2, 3.5), scene=scene)
        self.bodies.apply('tool', (0.1, 0, -0.2), (10, 2, 3), (0, 1, 2))
        self.bodies.apply('forearm', (0, 0, 0), (-4, 0, 5), (0, 0, 0), root_axes=True)
        self.assertEffort(effort, self.bodies, STATE, EXACT)
        self.assertReactions(reactions, self.bodies, STATE, EXACT)

    def test_static_scene_takes_joint_states_as_they_come(self):
        effort, = self.start('effort', scene={'motion': 'static'})
        self.assertEffort(effort, self.bodies, (STATE[0], ZERO, ZERO), EXACT)
        states = self.node.feed('joint_states', JointState)
        recorder = self.node.record('effort', JointState)
        states.publish(joint_state(EPOCH, *STATE[:2]))
        message = recorder.wait(1)[0]
        self.assertEqual(message.header.stamp.to_nsec(), EPOCH)
        self.assertEffort(message, self.bodies, (STATE[0], ZERO, ZERO), EXACT)

    def test_without_the_active_component(self):
        reactions, effort = self.start('reactions', 'effort', scene={'include_active': False})
        self.assertEffort(effort, self.bodies, STATE, EXACT)
        for name, wrench in zip(reactions.joint_names, reactions.wrench):
            expected = self.bodies.reaction(name, *STATE)
            axis = expected.pose[:3, :3] @ self.bodies.axis(name)
            force, torque = expected.force, expected.torque
            if self.bodies.slides(name):
                force = force - axis @ force * axis
            else:
                torque = torque - axis @ torque * axis
            self.assertClose(vector(wrench.force), force, EXACT, 'force of ' + name)
            self.assertClose(vector(wrench.torque), torque, EXACT, 'torque of ' + name)

    def test_moments_about_points_of_the_scene(self):
        place = (0.1, 0, 0.2)
        reactions, elbow = self.start(
            'reactions', 'reaction/elbow', twist=True,
            scene={'moments_about': [{'name': 'elbow', 'link': 'stand', 'at': list(place)}]})
        # A WrenchStamped is about the origin of its frame.
        self.assertEqual(elbow.header.frame_id, 'forearm')
        self.assertWrench(elbow, self.bodies, 'elbow', STATE, EXACT)
        # The other message says by its transform which point its moment is about.
        index = reactions.joint_names.index('elbow')
        expected = self.bodies.reaction('elbow', *STATE)
        lever = expected.pose[:3, 3] - place
        wrench, twist = reactions.wrench[index], reactions.twist[index]
        self.assertClose(vector(reactions.transforms[index].translation), place, EXACT, 'point')
        self.assertClose(vector(wrench.force), expected.force, EXACT, 'force')
        self.assertClose(vector(wrench.torque), expected.torque + cross(lever, expected.force),
                         EXACT, 'torque')
        self.assertClose(vector(twist.linear), expected.linear + cross(lever, expected.angular),
                         EXACT, 'velocity')
        shoulder = self.bodies.reaction('shoulder', *STATE)
        other = reactions.joint_names.index('shoulder')
        self.assertClose(vector(reactions.wrench[other].torque), shoulder.torque, EXACT, 'shoulder')

    def test_no_reactions(self):
        effort, = self.start('effort', scene={'reactions': 'none'})
        self.assertEffort(effort, self.bodies, STATE, EXACT)
        self.assertEqual(set(self.advertised()), {self.node.name + '/' + topic
                                                  for topic in ('effort', 'motion',
                                                                'effort_deviation', 'residual',
                                                                'external_effort',
                                                                'joint_trajectory')})

    def test_diagnostics(self):
        self.start('effort', 'reaction/elbow')
        values = self.node.wait_for_count('trajectory points computed', 1)
        for key in ('input rate (Hz)', 'output rate (Hz)', 'run time per sample, median (us)',
                    'run time per sample, p99 (us)', 'run time per sample, worst (us)'):
            self.assertGreaterEqual(float(values[key]), 0, key)
        self.assertEqual(values['joints waited for'], 'none')
        status = self.node.statuses()[-1]
        self.assertEqual((status.level, status.message), (status.OK, 'running'))
        self.assertEqual(status.hardware_id, 'test_arm')
        # One joint of three: the others are waited for.
        states = self.node.feed('joint_states', JointState)
        states.publish(joint_state(EPOCH, {'elbow': 0.0}))
        values = self.node.diagnostics(lambda v: v['joints waited for'] != 'none', 'joints')
        self.assertEqual(values['joints waited for'], 'shoulder, slide')
        status = self.node.statuses()[-1]
        self.assertEqual(status.level, status.WARN)
        self.assertIn('waiting for joints: shoulder, slide', status.message)
        # And still are when nothing more comes.
        self.assertEqual(self.node.diagnostics()['joints waited for'], 'shoulder, slide')

    def test_small_messages_are_not_held_back(self):
        self.start('effort')
        for publisher in (self.node.feed('joint_states', JointState),
                          self.node.feed('joint_trajectory', JointTrajectory)):
            # rospy sets the option for those subscribers only that ask for it.
            peer = publisher.impl.connections[0]._connection.socket
            self.assertNotEqual(peer.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY), 0)


if __name__ == '__main__':
    run(Outputs)
