#!/usr/bin/python3
"""Recordings through trajectory_publisher_node: how they start and end, and drivers that wrap."""
import math
import tempfile

import rospy
from sensor_msgs.msg import JointState

from node_under_test import Node, NodeTest, Process, executable, run

# 1 kg at 1 m below the axis y: its effort at the angle q is G sin q when it turns steadily.
G = 9.81
PENDULUM = """<robot name="pendulum"><link name="base"/>
  <link name="bob"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
    <inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="wheel" type="%s"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/>
    <limit lower="-20" upper="20" effort="1" velocity="1"/></joint></robot>"""
# Rounding of positions of up to 6 rad, 1e-15, over the squared time from row to row, and the six of
# a cubic's second derivative; for rows a hundredth of a second apart.
SPLINE = 1e-10
STEADY = 3.0  # rad/s


class RecordedTables(NodeTest):
    def play(self, positions, kind='continuous', message='joint_trajectory', step=0.01):
        """The messages of ~effort for rows of positions."""
        table = tempfile.NamedTemporaryFile('w', suffix='.csv')
        self.addCleanup(table.close)
        table.write('time,position.wheel\n')
        for i, position in enumerate(positions):
            table.write('%r,%r\n' % (i * step, position))
        table.flush()
        node = Node(self, PENDULUM % kind, {'estimator': {'acceleration': 'zero'}})
        effort = node.record('effort', JointState)
        node.wait_for_plan('effort')
        name = node.namespace + '/trajectory_publisher'
        rospy.set_param(name, {'law': 'table', 'joints': [], 'file': table.name, 'rate': 500,
                               'message': message, 'start_delay': 0})
        player = Process(self, [executable('trajectory_publisher_node'),
                                '__ns:=' + node.namespace, '__name:=trajectory_publisher'])
        count = round((len(positions) - 1) * step * 500) + 1
        messages = effort.wait(count)
        self.assertEqual(player.wait(), 0, player.output())
        self.assertEqual(len(messages), count)
        return messages

    def assertSteady(self, messages, start=0.0):
        for i, result in enumerate(messages):
            angle = start + STEADY * i / 500
            self.assertClose(result.position, [angle], SPLINE, 'position %d' % i)
            self.assertClose(result.velocity, [STEADY], SPLINE, 'velocity %d' % i)
            self.assertClose(result.effort, [G * math.sin(angle)], SPLINE, 'effort %d' % i)

    def test_a_recording_that_moves_from_the_first_row_to_the_last(self):
        self.assertSteady(self.play([STEADY * 0.01 * i for i in range(200)]))

    def test_recordings_of_a_driver_that_wraps(self):
        wrapped = [math.remainder(STEADY * 0.01 * i, 2 * math.pi) for i in range(400)]
        for kind in ('continuous', 'revolute'):
            for message in ('joint_trajectory', 'joint_state'):
                self.assertSteady(self.play(wrapped, kind, message))

    def test_a_recording_of_few_rows_that_wraps(self):
        # More than half a second from row to row: the description says that the wheel turns on.
        wrapped = [math.remainder(STEADY * 0.6 * i, 2 * math.pi) for i in range(6)]
        self.assertSteady(self.play(wrapped, step=0.6))


if __name__ == '__main__':
    run(RecordedTables)
