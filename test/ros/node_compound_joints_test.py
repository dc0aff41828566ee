#!/usr/bin/python3
"""Joints of several freedoms: their parts by name in joint states, efforts and reactions."""
import math

from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

from node_under_test import EPOCH, Node, NodeTest, joint_state, run, vector

# A cart of 10 kg on a floor, with 2 kg at 0.5 m along its x axis; URDF's planar joint slides along x and y
# of its frame, then turns about z.
CART = """<robot name="cart"><link name="floor"/>
  <link name="body"><inertial><mass value="10"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="load"><inertial><mass value="2"/>
    <inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="wheels" type="planar"><parent link="floor"/><child link="body"/><axis xyz="0 0 1"/></joint>
  <joint name="rod" type="fixed"><parent link="body"/><child link="load"/><origin xyz="0.5 0 0"/></joint>
  </robot>"""
GRAVITY = (0.7, -0.4, -9.81)
POSITION = {'wheels.angle': 0.6, 'wheels.x': 3.0, 'wheels.y': -1.0}
ROUNDING = 1e-13


class CompoundJoints(NodeTest):
    def test_planar_joint(self):
        node = Node(self, CART, {'scene': {'motion': 'static', 'gravity': list(GRAVITY),
                                           'include_active': False}})
        efforts = node.record('effort', JointState)
        reactions = node.record('reaction/wheels', WrenchStamped)
        states = node.feed('joint_states', JointState)
        node.wait_for_plan('effort', 'reaction/wheels')
        states.publish(joint_state(EPOCH, POSITION))
        effort = dict(zip(*(lambda m: (m.name, m.effort))(efforts.wait(1)[0])))
        turn = POSITION['wheels.angle']
        moment = -2 * 0.5 * (math.cos(turn) * GRAVITY[1] - math.sin(turn) * GRAVITY[0])
        self.assertEqual(set(effort), set(POSITION))
        self.assertClose([effort['wheels.x'], effort['wheels.y'], effort['wheels.angle']],
                         [-12 * GRAVITY[0], -12 * GRAVITY[1], moment], ROUNDING, 'efforts')
        # What the floor bears: the weight, at 0.5 m from 2 kg of it, in axes of the cart.
        wrench = reactions.wait(1)[0].wrench
        self.assertClose(vector(wrench.force), [0, 0, -12 * GRAVITY[2]], ROUNDING, 'force')
        self.assertClose(vector(wrench.torque), [0, 2 * 0.5 * GRAVITY[2], 0], ROUNDING, 'moment')


if __name__ == '__main__':
    run(CompoundJoints)
