#!/usr/bin/python3
"""Couplings in the node: a motor that moves an arm and a rack by gears, in closed form."""
import math
import os
import shutil
import subprocess
import tempfile

import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from trajectory_msgs.msg import JointTrajectory
import yaml

from closed_loops import CLOSED_FORM, STEP, LoopTest, by_name
from node_under_test import (EPOCH, Polynomials, executable, joint_state, ros_time, run,
                             trajectory_point)

# The estimator's rounding on a cubic, in accelerations of links of some kg.
ESTIMATED = 1e-8
# A few roundings to a link, relative to the sums of magnitudes.
SOUND = 1e-13
LAG = 5  # samples: ~estimator/lag of 0.05 s
BODY = ('<link name="%s"><inertial><origin xyz="%s"/><mass value="%s"/><inertia ixx="0.03" iyy="%s" '
        'izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>')
JOINT = ('<joint name="%s" type="%s"><parent link="base"/><child link="%s"/><axis xyz="%s"/>'
         '<limit lower="-9" upper="9" effort="1e4" velocity="9"/></joint>')
DRIVE = ('<robot name="drive"><link name="base"/>' + BODY % ('rotor', '0 0 0', 0.1, 1e-4) +
         BODY % ('bar', '0 0 -0.5', 2, 0.03) + BODY % ('rail', '0 0 0', 3, 0.03) +
         JOINT % ('motor', 'continuous', 'rotor', '0 1 0') +
         JOINT % ('arm', 'continuous', 'bar', '0 1 0') +
         JOINT % ('rack', 'prismatic', 'rail', '0 0 1') + '</robot>')
LIFT = ('<transmission name="lift"><type>transmission_interface/SimpleTransmission</type>'
        '<joint name="arm"><offset>0.1</offset></joint><actuator name="drum">'
        '<mechanicalReduction>-80</mechanicalReduction></actuator></transmission>')
SCENE = {'actuated': ['motor'], 'couplings': [
    {'name': 'reducer', 'offset': 0,
     'terms': [{'name': 'motor', 'factor': 1}, {'name': 'arm', 'factor': -50}]},
    {'name': 'pinion', 'terms': [{'name': 'rack', 'factor': 1}, {'name': 'motor', 'factor': -0.002}]}]}
# Results are in depth-first order, children by joint name.
NAMES = ['arm', 'motor', 'rack', 'reducer', 'pinion']
TURN, RACK = (3.0, 20.0, 15.0, -8.0), (0.1, 0.3, -0.2, 0.4)
MOTOR = Polynomials(motor=TURN)
# A belt that may slip, and a motor for the arm, the drum.
LIFTED = DRIVE.replace('</robot>', LIFT + '</robot>')
BELT = {'urdf_transmissions': 'all', 'actuated': ['arm', 'rack'], 'couplings': [
    {'name': 'belt', 'rate_only': True,
     'terms': [{'name': 'motor', 'factor': 1}, {'name': 'arm', 'factor': -50}]}]}


def efforts(turn, acceleration):
    arm = 0.53 * acceleration / 50 + 9.81 * math.sin(turn / 50)
    rack = 3 * (9.81 + 0.002 * acceleration)
    return [0, 1e-4 * acceleration + arm / 50 + 0.002 * rack, 0, -arm / 50, rack]


class Couplings(LoopTest):
    def test_the_motor_alone_is_given(self):
        self.start('effort', 'determinacy', robot=DRIVE, scene=SCENE,
                   parameters={'certificates': True, 'cross_check_rate': 1000})
        stamps = [EPOCH + STEP * i for i in range(60)]
        for ns in stamps:
            q, qd, _ = MOTOR(ns)
            self.states.publish(joint_state(ns, q, qd))
        messages = self.recorders['effort'].wait(len(stamps) - LAG)
        self.assertStamps(messages, stamps[:-LAG])
        for ns, message in zip(stamps, messages):
            (turn,), (rate,), (acceleration,) = (list(level.values()) for level in MOTOR(ns))
            self.assertEqual(message.name, NAMES)
            self.assertClose(message.effort, efforts(turn, acceleration), ESTIMATED, 'efforts')
            self.assertClose(message.position, [turn / 50, turn, 0.002 * turn, 0, 0], ESTIMATED,
                             'positions, sums of couplings included')
            self.assertClose(message.velocity, [rate / 50, rate, 0.002 * rate, 0, 0], ESTIMATED,
                             'velocities')
        values = self.node.diagnostics(
            lambda values: 'certificate: power (largest, relative)' in values and
            'cross-check, largest difference (relative)' in values, 'checks')
        self.assertLess(float(values['certificate: power (largest, relative)']), SOUND)
        self.assertLess(float(values['cross-check, largest difference (relative)']), SOUND)
        self.assertLess(float(values['residual.position.pinion']), 1e-9)
        self.assertIn('residual.velocity.reducer', values)
        flags = {value.key: value.value
                 for value in self.recorders['determinacy'].wait(1)[0].status[0].values}
        self.assertEqual((flags['reducer'], flags['pinion']), ('1', '1'))
        for status in self.node.statuses():
            self.assertEqual(status.level, DiagnosticStatus.OK, status)

    def test_a_motion_that_violates_one_is_a_warning(self):
        self.start('effort', robot=DRIVE, scene=SCENE,
                   parameters={'estimator': {'acceleration': 'zero'}})
        still = dict.fromkeys(['motor', 'arm', 'rack'], 0.0)
        self.states.publish(joint_state(EPOCH, dict(still, arm=0.001), still))
        message = self.recorders['effort'].wait(1)[0]
        self.assertEqual(by_name(message, message.position)['arm'], 0.001)
        self.assertClose([by_name(message, message.position)['reducer']], [-0.05], CLOSED_FORM, 'sum')
        status = self.node.wait_for_status("positions violate coupling 'reducer' by 0.05 m or rad")
        self.assertEqual(status.level, DiagnosticStatus.WARN)

    def test_transmissions_are_read_on_request(self):
        self.start('effort', robot=DRIVE.replace('</robot>', LIFT + '</robot>'),
                   scene={'urdf_transmissions': 'all'},
                   parameters={'estimator': {'acceleration': 'zero'}})
        at = {'motor': 0.0, 'arm': 0.4, 'rack': 0.1}
        self.states.publish(joint_state(EPOCH, at, dict.fromkeys(at, 0.0)))
        message = self.recorders['effort'].wait(1)[0]
        self.assertEqual(message.name, ['arm', 'drum', 'motor', 'rack', 'lift.drum'])
        self.assertClose(message.effort, [0, 9.81 * math.sin(0.4) / -80, 0, 3 * 9.81,
                                          -9.81 * math.sin(0.4) / -80], CLOSED_FORM, 'efforts')
        self.assertClose(message.position, [0.4, -80 * (0.4 - 0.1), 0, 0.1, 8], CLOSED_FORM,
                         'positions')
        self.assertTrue(any("transmissions 'lift' are read" in line
                            for line in self.node.lines('WARN')), self.node.lines('WARN'))
        topics = [name for name, _ in rospy.get_published_topics(self.node.name + '/reaction')]
        self.assertFalse([name for name in topics if 'drum' in name], topics)

    def test_motors_follow_where_all_joints_are_given(self):
        motion = Polynomials(motor=TURN, rack=RACK, arm=tuple(c / 50 for c in TURN))
        self.start('effort', robot=LIFTED, scene=BELT, parameters={'certificates': True})
        stamps = [EPOCH + STEP * i for i in range(60)]
        states = [joint_state(ns, *motion(ns)[:2]) for ns in stamps]
        for state in states:
            self.states.publish(state)
        messages = self.recorders['effort'].wait(len(stamps) - LAG)
        self.assertStamps(messages, stamps[:-LAG])
        for message in messages:
            self.assertDrum(message, motion, ESTIMATED)
        values = self.node.diagnostics(
            lambda values: 'certificate: power (largest, relative)' in values, 'certificates')
        self.assertLess(float(values['certificate: power (largest, relative)']), SOUND)
        self.assertEqual(values['joints waited for'], 'none')
        self.compare_with_bag(states, messages)

    def test_motors_follow_in_trajectories(self):
        motion = Polynomials(motor=TURN, rack=RACK, arm=tuple(c / 50 for c in TURN))
        for sampling in (0, 200):
            self.start('effort', robot=LIFTED, scene=BELT,
                       parameters={'trajectory_sampling': sampling})
            names = ['motor', 'arm', 'rack']
            message = JointTrajectory(joint_names=names)
            message.header.stamp = ros_time(EPOCH)
            for i in range(10):
                message.points.append(trajectory_point(STEP * i, names, motion(EPOCH + STEP * i)))
            self.trajectories.publish(message)
            count = 19 if sampling else 10
            messages = self.recorders['effort'].wait(count)
            self.assertEqual(len(messages), count)
            for effort in messages:
                self.assertDrum(effort, motion, ESTIMATED)

    def assertDrum(self, message, motion, tolerance):
        """The drum lifts the arm, which turns the motor by a belt that may slip."""
        q, qd, qdd = motion(message.header.stamp.to_nsec())
        expected = {'drum': (-80 * (q['arm'] - 0.1), -80 * qd['arm'],
                             (0.53 * qdd['arm'] + 9.81 * math.sin(q['arm']) +
                              50 * 1e-4 * qdd['motor']) / -80),
                    'arm': (q['arm'], qd['arm'], 0), 'motor': (q['motor'], qd['motor'], 0),
                    'rack': (q['rack'], qd['rack'], 3 * (9.81 + qdd['rack']))}
        for name, values in expected.items():
            at = message.name.index(name)
            self.assertClose([message.position[at], message.velocity[at], message.effort[at]], values,
                             tolerance, name)

    def compare_with_bag(self, states, live):
        """The tool finds the same in a bag."""
        folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, folder)
        path = {name: os.path.join(folder, name)
                for name in ('robot.urdf', 'scene.yaml', 'run.bag', 'results.bag')}
        with rosbag.Bag(path['run.bag'], 'w') as bag:
            for state in states:
                bag.write('/joint_states', state, state.header.stamp)
        for name, content in (('robot.urdf', LIFTED), ('scene.yaml', yaml.safe_dump(BELT))):
            with open(path[name], 'w', encoding='utf-8') as file:
                file.write(content)
        subprocess.run([executable('inverse_dynamics_offline'), '--urdf', path['robot.urdf'],
                        '--scene', path['scene.yaml'], '--motion', path['run.bag'], '--output',
                        path['results.bag']], check=True)
        with rosbag.Bag(path['results.bag']) as bag:
            recorded = [message for topic, message, _ in bag.read_messages()
                        if topic.endswith('effort')]
        self.assertEqual(len(recorded), len(live))
        for one, other in zip(recorded, live):
            self.assertEqual((one.header.stamp, one.name, one.position, one.velocity, one.effort),
                             (other.header.stamp, other.name, other.position, other.velocity,
                              other.effort))

    def test_the_log_lists_them(self):
        self.start('effort', robot=DRIVE, scene=SCENE)
        self.assertTrue(any('closed loops: 0 closures, 0 springs, 2 couplings; actuated: motor; '
                            'passive: arm, rack' in line for line in self.node.lines('INFO')),
                        self.node.lines('INFO'))


if __name__ == '__main__':
    run(Couplings)
