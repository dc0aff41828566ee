#!/usr/bin/python3
"""Couplings in the node: a motor that moves an arm and a rack by gears, in closed form."""
import math

import rospy
from diagnostic_msgs.msg import DiagnosticStatus

from closed_loops import CLOSED_FORM, STEP, LoopTest, by_name
from node_under_test import EPOCH, Polynomials, joint_state, run

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
MOTOR = Polynomials(motor=(3.0, 20.0, 15.0, -8.0))


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

    def test_the_log_lists_them(self):
        self.start('effort', robot=DRIVE, scene=SCENE)
        self.assertTrue(any('closed loops: 0 closures, 0 springs, 2 couplings; actuated: motor; '
                            'passive: arm, rack' in line for line in self.node.lines('INFO')),
                        self.node.lines('INFO'))


if __name__ == '__main__':
    run(Couplings)
