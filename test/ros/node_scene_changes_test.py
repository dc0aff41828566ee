#!/usr/bin/python3
"""Payloads and gravity that change while the node runs."""
import math
import random
import time

from geometry_msgs.msg import InertiaStamped, Vector3Stamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory

from node_under_test import (EPOCH, Node, NodeTest, Recorder, joint_state, ros_time, rotated, run,
                             trajectory_point, wait_until)

G = 9.81
# 1 kg at 1 m below the axis y: its effort is G sin q while it rests. The flange hangs together with it, its
# z axis along x of the bob.
PENDULUM = """<robot name="pendulum"><link name="base"/><link name="wall"/>
  <link name="bob"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="flange"/>
  <joint name="wheel" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint>
  <joint name="bolts" type="fixed"><parent link="bob"/><child link="flange"/>
    <origin xyz="0 0 -1.5" rpy="0 %r 0"/></joint>
  <link name="plate"/>
  <joint name="weld" type="fixed"><parent link="bob"/><child link="plate"/>
    <origin xyz="0 0 0" rpy="%r 0 %r"/></joint>
  <joint name="mount" type="fixed"><parent link="base"/><child link="wall"/>
    <origin xyz="0 0 1" rpy="%r 0 0"/></joint></robot>""" % (math.pi / 2, math.pi / 2, math.pi / 2, math.pi)
ANGLE = 0.7
STEP = 2000000  # ns
# Turns by quarters are of the description, with a rounding error of 1e-16 in each number.
EXACT = 1e-14


def payload(mass, at, frame='bob', **inertia):
    message = InertiaStamped()
    message.header.frame_id = frame
    message.inertia.m = mass
    message.inertia.com.x, message.inertia.com.y, message.inertia.com.z = at
    for name, value in inertia.items():
        setattr(message.inertia, name, value)
    return message


def gravity(vector, frame='base'):
    message = Vector3Stamped()
    message.header.frame_id = frame
    message.vector.x, message.vector.y, message.vector.z = vector
    return message


class SceneChanges(NodeTest):
    def start(self, scene=None, parameters=None, outputs=('effort',)):
        self.node = Node(self, PENDULUM, dict({'scene': dict({'motion': 'static'}, **(scene or {}))},
                                              **(parameters or {})))
        self.efforts = self.node.record('effort', JointState)
        self.states = self.node.feed('joint_states', JointState)
        self.node.wait_for_plan(*outputs)
        self.sent = 0

    def change(self, topic, message):
        """Publishes a message once the node listens; there is one publisher a topic."""
        self.publishers = getattr(self, 'publishers', {})
        if topic not in self.publishers:
            self.publishers[topic] = self.node.feed('inverse_dynamics/' + topic, type(message))
        self.publishers[topic].publish(message)

    def effort(self, angle=ANGLE):
        """Of another joint state, each of which has its result."""
        self.states.publish(joint_state(EPOCH + self.sent * STEP, {'wheel': angle}))
        self.sent += 1
        message = self.efforts.wait(self.sent)[-1]
        self.assertEqual(message.header.stamp.to_nsec(), EPOCH + (self.sent - 1) * STEP)
        return message.effort[0]

    def assertChanges(self, topic, message, before, after):
        """Results are those before or those after, change once, and none is lost."""
        self.assertClose([self.effort()], [before], EXACT, 'before')
        self.change(topic, message)
        found = []

        def changed():
            found.append(self.effort())
            return abs(found[-1] - after) <= EXACT * max(1, abs(after))
        wait_until(changed, lambda: '%r after %r, got %r' % (after, before, found[-1]))
        self.assertClose(found[:-1], [before] * (len(found) - 1), EXACT, 'until then')
        self.assertClose([self.effort()], [after], EXACT, 'after')
        self.assertEqual(len(self.efforts.messages()), self.sent)

    def test_payloads_and_gravity(self):
        self.start()
        bob = G * math.sin(ANGLE)
        self.assertChanges('payload/bob', payload(2, (0, 0, -0.5)), bob, 2 * bob)
        # Replaced, and by the frame of a link that hangs together with it: z of the flange is x.
        with_flange = bob + 3 * (1.5 * math.sin(ANGLE) - 0.25 * math.cos(ANGLE)) * G
        self.assertChanges('payload/bob', payload(3, (0, 0, 0.25), 'flange'), 2 * bob, with_flange)
        # Another link's is added.
        self.assertChanges('payload/flange', payload(1, (0, 0, -1), 'bob'), with_flange,
                           with_flange + bob)
        self.assertChanges('payload/bob', payload(0, (0, 0, 0)), with_flange + bob, 2 * bob)
        self.assertChanges('gravity', gravity((0, 0, -1.62)), 2 * bob, 2 * 1.62 * math.sin(ANGLE))
        # The wall's z axis points down.
        self.assertChanges('gravity', gravity((0, 0, G), 'wall'), 2 * 1.62 * math.sin(ANGLE), 2 * bob)
        values = self.node.wait_for_count('payloads and gravity received', 6)
        self.assertEqual(values['dropped'], '0')
        self.assertIn("link 'bob' carries 2 kg at [0, 0, -0.5] m", self.node.output())

    def test_contacts_are_lifted_and_closed(self):
        # The bob leans on a wall without friction, which holds it as the motor would have to.
        wall = {'link': 'base', 'point': [-math.sin(ANGLE), 0, 0], 'normal': [-1, 0, 0]}
        self.start({'contacts': [{'name': 'rest', 'link': 'bob', 'at': [0, 0, -1], 'slip': 'all',
                                  'plane': wall}],
                    'assembly': [{'name': 'wheel', 'position': ANGLE}]})
        bob = G * math.sin(ANGLE)
        self.assertChanges('contact/rest', Bool(False), 0, bob)
        self.assertChanges('contact/rest', Bool(True), bob, 0)
        self.assertIn("'rest' is lifted", self.node.output())
        # Either of motor and wall could hold the bob.
        self.effort()
        self.node.diagnostics(
            lambda values: 'not determined' in values.get('holds.rest', ''), 'holds.rest')

    def test_contacts_open_and_close_by_their_gap(self):
        # The bob leans on the wall as above, and leaves it by so much, m.
        def at(gap):
            return math.asin(math.sin(ANGLE) + gap)
        wall = {'link': 'base', 'point': [-math.sin(ANGLE), 0, 0], 'normal': [-1, 0, 0]}
        self.start({'contacts': [{'name': 'rest', 'link': 'bob', 'at': [0, 0, -1], 'slip': 'all',
                                  'plane': wall, 'gap': {'close': 0.001, 'open': 0.003}}],
                    'assembly': [{'name': 'wheel', 'position': ANGLE}]})
        noise = random.Random(5)

        def rests(gap, lifted):
            """For longer than a plan takes, with noise of less than what lies between."""
            for _ in range(40):
                angle = at(gap + noise.uniform(-0.0009, 0.0009))
                expected = G * math.sin(angle) if lifted else 0
                self.assertClose([self.effort(angle)], [expected], EXACT, 'at %r' % gap)
                time.sleep(0.005)

        def comes(gap, lifted):
            expected = G * math.sin(at(gap)) if lifted else 0
            wait_until(lambda: abs(self.effort(at(gap)) - expected) <= EXACT * 10,
                       lambda: '%r at %r' % (expected, gap))
        rests(0.002, False)
        comes(0.0031, True)
        rests(0.002, True)
        comes(-0.01, False)
        rests(0.002, False)
        self.assertEqual(self.node.output().count("'rest' is lifted"), 1)

    def test_contacts_that_would_pull_are_warned_of(self):
        # On the other side of the bob a wall would have to pull.
        for normal, found in ((1, 'other way'), (-1, 'yes')):
            wall = {'link': 'base', 'point': [-math.sin(ANGLE), 0, 0], 'normal': [normal, 0, 0]}
            self.start({'contacts': [{'name': 'rest', 'link': 'bob', 'at': [0, 0, -1], 'slip': 'all',
                                      'plane': wall}], 'actuated': [], 'given': ['wheel'],
                        'assembly': [{'name': 'wheel', 'position': ANGLE}]})
            self.assertClose([self.effort()], [0], EXACT, 'effort')
            self.node.diagnostics(
                lambda values: found in values.get('holds.rest', ''), 'holds.rest ' + found)

    def test_tf_has_the_frames_of_contacts(self):
        # A wheel of 0.2 m at the bob's end rolls on the inside of a wall, where it touches it.
        wall = {'link': 'base', 'point': [-math.sin(ANGLE) - 0.2, 0, 0], 'normal': [1, 0, 0]}
        self.start({'rolling': [{'name': 'roller', 'link': 'bob', 'centre': [0, 0, -1],
                                 'axis': [0, 1, 0], 'radius': 0.2, 'slip': 'all', 'plane': wall}],
                    'assembly': [{'name': 'wheel', 'position': ANGLE}]})
        frames = Recorder('/tf', TFMessage)
        self.addCleanup(frames.stop)
        self.node.diagnostics(
            lambda values: '/tf' in values['subscribed outputs'].split(', '), 'a plan with /tf')
        self.effort()
        transform = frames.wait(1)[-1].transforms[0]
        self.assertEqual((transform.header.frame_id, transform.child_frame_id), ('base', 'roller'))
        self.assertEqual(transform.header.stamp.to_nsec(), EPOCH + (self.sent - 1) * STEP)
        place, turn = transform.transform.translation, transform.transform.rotation
        self.assertClose([place.x, place.y, place.z],
                         [-math.sin(ANGLE) - 0.2, 0, -math.cos(ANGLE)], EXACT, 'contact')
        self.assertClose(rotated(turn, 2), [1, 0, 0], EXACT, 'normal')
        self.assertClose(rotated(turn, 1), [0, 1, 0], EXACT, 'axle')
        # What is planned is not there, and the rest comes at ~marker_rate.
        trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        message = JointTrajectory(joint_names=['wheel'])
        message.header.stamp = ros_time(EPOCH + 1000 * STEP)
        message.points = [trajectory_point(i * STEP, ['wheel'], ({'wheel': 0.1}, {'wheel': 0}, {'wheel': 0}))
                          for i in range(10)]
        trajectories.publish(message)
        planned = self.efforts.wait(self.sent + 10)
        self.assertEqual(len(planned), self.sent + 10)
        time.sleep(0.06)
        for i in range(100):
            self.states.publish(joint_state(EPOCH + (self.sent + i) * STEP, {'wheel': ANGLE}))
        self.efforts.wait(self.sent + 110)
        found = frames.wait(2)
        stamps = [each.transforms[0].header.stamp.to_nsec() for each in found]
        self.assertLess(max(stamps), EPOCH + 1000 * STEP)
        self.assertLessEqual(len(found), 2 + 20 * 100 * STEP * 1e-9)

    def pads(self, *closed):
        """The bob on two pads without friction on both sides, and nothing else that would hold it."""
        def pad(name, side):
            plane = {'link': 'base', 'point': [-math.sin(ANGLE), 0, 0], 'normal': [side, 0, 0]}
            return {'name': name, 'link': 'bob', 'at': [0, 0, -1], 'slip': 'all', 'plane': plane,
                    'closed': name in closed}
        return {'contacts': [pad('left', -1), pad('right', 1)], 'actuated': [], 'given': ['wheel'],
                'assembly': [{'name': 'wheel', 'position': ANGLE}]}

    def normal_force(self, name):
        """Of a result that begins now."""
        self.effort()
        message = self.recorded[name].wait(self.sent)[-1]
        return message.wrench.force.z

    def test_what_is_refused_is_tried_again(self):
        self.start(self.pads('right'))
        self.recorded = {name: self.node.record('reaction/' + name, WrenchStamped)
                         for name in ('left', 'right')}
        self.node.wait_for_plan('effort', 'reaction/left', 'reaction/right')
        # Before any result of these topics.
        self.sent, self.efforts = 0, self.node.record('effort', JointState)
        right = self.normal_force('right')
        self.assertGreater(abs(right), 1)
        # Nothing would hold the bob: refused by name. The payload with it is not.
        self.change('contact/right', Bool(False))
        self.change('payload/bob', payload(1, (0, 0, -1)))
        wait_until(lambda: "'right' is lifted (" in self.node.output(), self.node.output)
        wait_until(lambda: abs(self.normal_force('right') - 2 * right) < 1e-9,
                   lambda: 'twice %r' % right)
        self.assertEqual(self.normal_force('left'), 0)
        self.change('contact/left', Bool(True))
        wait_until(lambda: abs(self.normal_force('left') + 2 * right) < 1e-9, self.node.output)
        self.assertEqual(self.normal_force('right'), 0)
        self.assertEqual(self.node.output().count("'right' is lifted ("), 1)

    def test_what_sticks_does_so_where_it_is(self):
        # A pad that a motor holds, and that sticks; the scene has it at another angle.
        floor = {'link': 'base', 'point': [0, 0, -math.cos(ANGLE)], 'normal': [0, 0, 1]}
        self.start({'contacts': [{'name': 'pad', 'link': 'bob', 'at': [0, 0, -1], 'plane': floor,
                                  'closed': False}],
                    'assembly': [{'name': 'wheel', 'position': 0}]})
        self.assertClose([self.effort()], [G * math.sin(ANGLE)], EXACT, 'effort')
        self.change('contact/pad', Bool(True))

        def touches():
            self.effort()
            return "'pad' touches" in self.node.output()
        wait_until(touches, self.node.output)
        before = self.node.wait_for_count('samples computed', self.sent)['samples that violate a loop']
        for _ in range(10):
            self.effort()
        values = self.node.wait_for_count('samples computed', self.sent)
        self.assertEqual(values['samples that violate a loop'], before)

    def test_payloads_of_the_scene_are_replaced(self):
        self.start({'payload': [{'link': 'bob', 'mass': 1, 'at': [0, 0, -1]}]})
        bob = G * math.sin(ANGLE)
        self.assertChanges('payload/bob', payload(4, (0, 0, -0.5)), 2 * bob, 3 * bob)

    def test_inertia_is_turned_into_the_links_axes(self):
        """The pendulum's axis is the plate's x axis, and it hangs while it begins to turn."""
        node = Node(self, PENDULUM)
        efforts = node.record('effort', JointState)
        trajectories = node.feed('joint_trajectory', JointTrajectory)
        payloads = node.feed('inverse_dynamics/payload/bob', InertiaStamped)
        node.wait_for_plan('effort')
        sent = []

        def effort():
            message = JointTrajectory(joint_names=['wheel'])
            message.header.stamp = ros_time(EPOCH + len(sent) * STEP)
            message.points = [trajectory_point(0, ['wheel'], ({'wheel': 0}, {'wheel': 0}, {'wheel': 2}))]
            trajectories.publish(message)
            sent.append(message)
            return efforts.wait(len(sent))[-1].effort[0]
        self.assertClose([effort()], [2 * 1.1], EXACT, 'before')
        payloads.publish(payload(1, (0, 0, 0), 'plate', ixx=0.6, iyy=0.5, izz=0.7))
        wait_until(lambda: effort() > 2.3, lambda: 'an effort of more than 2.2')
        self.assertClose([effort()], [2 * (1.1 + 0.6)], EXACT, 'after')

    def test_deviations_know_of_the_change(self):
        self.start({'tolerances': {'mass': 0.1}})
        deviations = self.node.record('effort_tolerance', JointState)
        self.node.wait_for_plan('effort', 'effort_tolerance')
        bob = G * math.sin(ANGLE)
        self.effort()
        self.assertClose(deviations.wait(1)[-1].effort, [0.1 * bob], EXACT, 'tolerance')
        self.assertChanges('gravity', gravity((0, 0, -2 * G)), bob, 2 * bob)
        self.assertClose(deviations.wait(self.sent)[-1].effort, [0.2 * bob], EXACT, 'tolerance')

    def test_the_same_again_is_no_change(self):
        self.start()
        for _ in range(5):
            self.change('payload/bob', payload(1, (0, 0, -1)))
            self.change('gravity', gravity((0, 0, -G)))
        self.node.wait_for_count('payloads and gravity received', 10)
        self.assertClose([self.effort()], [2 * G * math.sin(ANGLE)], EXACT, 'effort')
        said = self.node.output()
        self.assertEqual(said.count('The scene has changed'), 1, said)
        self.assertNotIn('gravity is', said)

    def test_what_is_wrong_is_dropped(self):
        self.start()
        before = self.effort()
        for topic, message, reason, text in (
                ('payload/bob', payload(-1, (0, 0, 0)), 'no such body',
                 'mass: -1 kg is not a positive mass'),
                ('payload/bob', payload(1, (0, 0, 0), ixx=1), 'no such body', 'inertia: '),
                ('payload/bob', payload(float('nan'), (0, 0, 0)), 'not finite',
                 'it has a number that is not finite'),
                ('payload/bob', payload(1, (0, 0, 0), 'bop'), 'unknown frame',
                 "its frame 'bop' is not a link of robot 'pendulum'; did you mean 'bob'?"),
                ('payload/bob', payload(1, (0, 0, 0), 'wall'), 'unknown frame',
                 "its frame 'wall' moves against link 'bob', by joint 'wheel'"),
                ('gravity', gravity((0, 0, -G), 'bob'), 'unknown frame',
                 "its frame 'bob' moves against the root link, by joint 'wheel'"),
                ('gravity', gravity((0, 0, float('inf'))), 'not finite', 'its vector is not finite')):
            count = int(self.node.diagnostics()['dropped: ' + reason])
            self.change(topic, message)
            values = self.node.wait_for_count('dropped: ' + reason, count + 1)
            self.assertIn('%s/%s: %s' % (self.node.name, topic, text), values['last drop'])
            self.assertEqual(self.effort(), before)

    def test_gravity_of_a_moving_root_is_in_the_inertial_frame(self):
        self.start({'root': 'moving'}, {'root': {'source': 'odometry'}})
        self.change('gravity', gravity((0, 0, -1)))
        values = self.node.wait_for_count('dropped: unknown frame', 1)
        self.assertIn("its frame 'base' is not the inertial frame 'odom'", values['last drop'])


if __name__ == '__main__':
    run(SceneChanges)
