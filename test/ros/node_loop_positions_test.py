#!/usr/bin/python3
"""Closed loops in the node where positions matter: what is determined and what is left out,
branches, dead centres, loops that cannot be closed, frames of closures."""
import math

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import numpy as np
import rospy
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory
import yaml

from closed_loops import (CLOSED_FORM, JOINTS, REACTIONS, SLIDER_CRANK_SCENE, STEP, LoopTest,
                          SliderCrank, by_name, unit)
from node_under_test import (EPOCH, joint_state, read, ros_time, run, trajectory_point, vector,
                             wait_until)

FOUR_BAR = read('..', '..', 'urdf', 'four_bar.urdf')
FOUR_BAR_SCENE = yaml.safe_load(read('..', '..', 'config', 'four_bar_scene.yaml'))
COMPONENTS = ['fx', 'fy', 'fz', 'tx', 'ty', 'tz']
# Of the slider-crank with the crank above the slider's way, rad and m.
ASSEMBLY = [{'name': 'crank_joint', 'position': 0.8}, {'name': 'rod_joint', 'position': -1.04},
            {'name': 'slider_joint', 'position': 0.35}]
# Forces there are as many times those elsewhere as a radian over the angle.
NEAR_DEAD_CENTRE = 1e-11


def flags(message, place):
    """Keys and values of a status of ~determinacy."""
    return {entry.key: entry.value for entry in message.status[place].values}


class LoopPositions(LoopTest):
    def test_the_closure_has_a_frame(self):
        scene = dict(SLIDER_CRANK_SCENE, closures=[dict(
            SLIDER_CRANK_SCENE['closures'][0], child={'link': 'slider', 'rpy': [0, 0, 0.5]})])
        self.start('reaction/wrist_pin', scene=scene,
                   parameters={'frame_prefix': 'left/', 'estimator': {'acceleration': 'zero'}})
        frames = []
        subscriber = rospy.Subscriber('/tf_static', TFMessage,
                                      lambda message: frames.extend(message.transforms))
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: [f for f in frames if f.child_frame_id == 'left/wrist_pin'], 'the frame')
        frame = [f for f in frames if f.child_frame_id == 'left/wrist_pin'][0]
        self.assertEqual(frame.header.frame_id, 'left/slider')
        self.assertClose([frame.transform.rotation.z, frame.transform.rotation.w],
                         [math.sin(0.25), math.cos(0.25)], CLOSED_FORM, 'rotation')
        self.states.publish(joint_state(EPOCH, {'crank_joint': 0.4}))
        message = self.recorders['reaction/wrist_pin'].wait(1)[0]
        self.assertEqual(message.header.frame_id, 'left/wrist_pin')
        x, y = SliderCrank(0.4, 0, 0).pin
        self.assertClose(vector(message.wrench.force)[:2],
                         [math.cos(0.5) * x + math.sin(0.5) * y,
                          math.cos(0.5) * y - math.sin(0.5) * x], CLOSED_FORM, 'turned')

    def test_dead_centre_of_an_actuated_slider(self):
        scene = dict(SLIDER_CRANK_SCENE, actuated=['slider_joint'], assembly=ASSEMBLY)
        self.start('effort', 'reactions', 'reaction/wrist_pin', 'determinacy', scene=scene,
                   parameters={'estimator': {'acceleration': 'zero'}})
        motions = [SliderCrank(angle, 0, 0) for angle in (-0.04, -0.02, 0, 0.02, 0.04)]
        stamps = [EPOCH + STEP * i for i in range(5)]
        for ns, motion in zip(stamps, motions):
            self.states.publish(joint_state(ns, motion.q))
        efforts = self.recorders['effort'].wait(5)
        reactions = self.recorders['reactions'].wait(5)
        for motion, effort, reaction in zip(motions, efforts, reactions):
            if motion is motions[2]:
                # Nothing bears the weights: passive joints would have to, and have no effort either.
                self.assertEqual([list(field) for field in (
                    effort.name, effort.effort, effort.position, effort.velocity)], 4 * [[]])
                self.assertEqual((reaction.joint_names, reaction.wrench, reaction.transforms),
                                 ([], [], []))
                continue
            self.assertEqual(effort.name, JOINTS)
            slider = motion.torque / motion.slide_slope
            self.assertClose(effort.effort, [0, 0, slider], NEAR_DEAD_CENTRE, 'efforts')
            self.assertEqual(reaction.joint_names, REACTIONS)
            self.assertEqual(len(reaction.transforms), 4)
        self.assertStamps(efforts, stamps)
        self.assertStamps(self.recorders['reaction/wrist_pin'].wait(4), stamps[:2] + stamps[3:])
        found = self.recorders['determinacy'].wait(3)
        self.assertStamps(found, [0, stamps[2], stamps[3]])
        self.assertEqual([message.status[0].level for message in found],
                         [DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.OK])
        self.assertEqual([flags(message, 0)['slider_joint'] for message in found], ['1', '0', '1'])
        self.assertEqual([flags(message, 0)['free motions'] for message in found], ['0', '1', '0'])
        status = self.status(lambda s: 'singular' in s.message, 'the singular position',
                             from_the_start=True)
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn('1 sample in singular positions', status.message)
        self.assertIn('left out: effort of crank_joint, effort of rod_joint, effort of '
                      'slider_joint, reaction of crank_joint', status.message)
        self.assertFalse(self.node.ended())

    def test_close_to_dead_centre(self):
        scene = dict(SLIDER_CRANK_SCENE, actuated=['slider_joint'], assembly=ASSEMBLY)
        self.start('effort', 'determinacy', scene=scene,
                   parameters={'estimator': {'acceleration': 'zero'}, 'condition_warn': 1e5})
        stamps = iter(EPOCH + STEP * i for i in range(10))

        def move(angle):
            self.states.publish(joint_state(next(stamps), SliderCrank(angle, 0, 0).q))

        move(0.04)
        status = self.status(lambda s: s.level == DiagnosticStatus.OK and 'condition' in
                             {entry.key for entry in s.values}, 'a position like others')
        move(1e-7)
        status = self.status(lambda s: 'close' in s.message, 'the position close to dead centre',
                             from_the_start=True)
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertRegex(status.message, "close to a singular position of the loops through "
                         "wrist_pin, condition [1-9][.0-9]*e\\+0[678]: .*; %s/condition_warn is "
                         "1e\\+05" % self.node.name)
        move(-0.04)
        self.status(lambda s: s.level == DiagnosticStatus.OK, 'a position like others again')
        self.assertEqual(self.node.wait_for_count('samples computed', 3)
                         ['samples close to singular positions'], '1')
        found = self.recorders['determinacy'].wait(3)
        self.assertEqual([message.status[0].level for message in found],
                         [DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.OK])
        self.assertIn('close to a singular position: condition', found[1].status[0].message)
        self.assertEqual(flags(found[1], 0)['slider_joint'], '1')

    def test_dead_centre_of_an_actuated_crank_is_a_position_like_others(self):
        self.start('effort', parameters={'estimator': {'acceleration': 'zero'}})
        for i, angle in enumerate((-0.02, 0, 0.02, math.pi)):
            self.states.publish(joint_state(EPOCH + STEP * i, {'crank_joint': angle}))
            self.assertMatches(self.recorders['effort'].wait(i + 1)[-1],
                               SliderCrank(angle, 0, 0), CLOSED_FORM)
        values = self.node.wait_for_count('samples computed', 4)
        self.assertEqual(values['samples in singular positions'], '0')

    def test_passive_joints_that_cannot_follow(self):
        scene = dict(SLIDER_CRANK_SCENE, actuated=['slider_joint'], assembly=ASSEMBLY)
        self.start('effort', scene=scene, parameters={'estimator': {'acceleration': 'zero'}})
        out_of_reach = 0.45
        for i, position in enumerate((0.35, out_of_reach, 0.3)):
            self.states.publish(joint_state(EPOCH + STEP * i, {'slider_joint': position},
                                            {'slider_joint': 0}))
        messages = self.recorders['effort'].wait(2)
        self.assertStamps(messages, [EPOCH, EPOCH + 2 * STEP])
        for message, position in zip(messages, (0.35, 0.3)):
            self.assertEqual(message.position[2], position)
            closed = SliderCrank(message.position[0], 0, 0)
            self.assertClose(message.position, list(closed.q.values()), CLOSED_FORM, 'closed')
            self.assertGreater(message.position[0], 0)  # the branch of the assembly
        values = self.node.wait_for_count('dropped: open loop', 1)
        self.assertIn("closure 'wrist_pin' stays open by 0.0", values['last drop'])
        trajectory = JointTrajectory(joint_names=['slider_joint'])
        trajectory.header.stamp = ros_time(EPOCH)
        zero = {'slider_joint': 0}
        trajectory.points = [
            trajectory_point(STEP * i, ['slider_joint'], ({'slider_joint': position}, zero, zero))
            for i, position in enumerate((0.3, out_of_reach, 0.29))]
        self.trajectories.publish(trajectory)
        self.assertStamps(self.recorders['effort'].wait(4)[2:], [EPOCH, EPOCH + 2 * STEP])
        values = self.node.wait_for_count('dropped: open loop', 2)
        self.assertIn('at point 2', values['last drop'])

    def test_turns_of_a_four_bar_and_what_is_determined(self):
        self.start('effort', 'reactions', robot=FOUR_BAR, scene=FOUR_BAR_SCENE,
                   parameters={'estimator': {'acceleration': 'zero'}})
        # Drivers wrap; a gap of a third of a turn is no way to another branch.
        angles = [math.remainder(0.05 * i, 2 * math.pi) for i in range(300)] + [1.0, 3.0, -1.2]
        for i, angle in enumerate(angles):
            self.states.publish(joint_state(EPOCH + STEP * i, {'crank_joint': angle}))
        for angle, message in zip(angles, self.recorders['effort'].wait(len(angles))):
            position = by_name(message, message.position)
            coupler = angle + position['coupler_joint']
            rocker = position['rocker_joint']
            pin = 0.12 * unit(angle) + 0.36 * unit(coupler)
            self.assertClose(pin, np.array([0.40, 0]) + 0.28 * unit(rocker), CLOSED_FORM, 'pin')
            side = pin - 0.12 * unit(angle)
            to_rocker = np.array([0.40, 0]) - 0.12 * unit(angle)
            self.assertGreater(to_rocker[0] * side[1] - to_rocker[1] * side[0], 0, 'branch')
            self.assertEqual(message.effort[1:], (0, 0))
        # Subscribed late, and latched; then it has not changed.
        found = self.node.record('determinacy', DiagnosticArray)
        numbers = flags(found.wait(1)[0], 0)
        self.assertEqual((numbers['redundant constraints'], numbers['redundancy'],
                          numbers['rank'], numbers['crank_joint']), ('3', '3', '3', '1'))
        for axes in (1, 2):
            components = flags(found.messages()[0], axes)
            self.assertEqual(len(components), 24)
            for joint in ('crank_joint', 'coupler_joint', 'rocker_joint', 'rocker_pin'):
                self.assertEqual([components[joint + '.' + c] for c in COMPONENTS],
                                 ['1', '1', '0', '0', '0', '1'])
        self.node.wait_for_plan('effort', 'reactions', 'determinacy')
        self.states.publish(joint_state(EPOCH + STEP * len(angles), {'crank_joint': -1.2}))
        self.recorders['effort'].wait(len(angles) + 1)
        self.node.wait_for_count('samples computed', len(angles) + 1)
        self.assertEqual(len(found.messages()), 1)

    def test_an_actuated_closure(self):
        scene = dict(SLIDER_CRANK_SCENE, actuated=['wrist_pin'], assembly=ASSEMBLY)
        self.start('effort', scene=scene, parameters={'estimator': {'acceleration': 'zero'}})
        # All joints have to be given.
        motion = SliderCrank(0.4, 1.5, 0)
        self.states.publish(joint_state(EPOCH, {'crank_joint': 0.4}))
        self.states.publish(joint_state(EPOCH + STEP, {**motion.q}, motion.qd))
        message = self.recorders['effort'].wait(1)[0]
        self.assertEqual(message.header.stamp.to_nsec(), EPOCH + STEP)
        self.assertEqual(message.name, JOINTS + ['wrist_pin'])
        # The slider does not turn, the rod does: the closure's child turns back relative to it.
        rod = motion.q['crank_joint'] + motion.q['rod_joint']
        self.assertClose(message.position[3:], [-rod], CLOSED_FORM, 'position')
        self.assertClose(message.velocity[3:], [-motion.qd['crank_joint'] -
                                                motion.qd['rod_joint']], CLOSED_FORM, 'velocity')
        self.assertClose(message.effort[:3], [0, 0, 0], CLOSED_FORM, 'passive')
        self.assertNotEqual(message.effort[3], 0)
        trajectory = JointTrajectory(joint_names=['crank_joint'])
        trajectory.points = [trajectory_point(0, ['crank_joint'], (motion.q, motion.qd, motion.qd))]
        self.trajectories.publish(trajectory)
        # The crank determines the others although the pin is what is actuated.
        filled = self.recorders['effort'].wait(2)[1]
        self.assertClose(filled.position[:3], list(motion.q.values()), CLOSED_FORM, 'completed')
        self.assertClose(filled.velocity[:3], list(motion.qd.values()), CLOSED_FORM, 'completed')


if __name__ == '__main__':
    run(LoopPositions)
