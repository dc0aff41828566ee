"""A slider-crank in closed form, and the node with closed loops, for its ROS tests."""
import math

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
import numpy as np
from sensor_msgs.msg import JointState, MultiDOFJointState
from trajectory_msgs.msg import JointTrajectory
import yaml

from node_under_test import Node, NodeTest, read, wait_until

SLIDER_CRANK = read('..', '..', 'urdf', 'slider_crank.urdf')
SLIDER_CRANK_SCENE = yaml.safe_load(read('..', '..', 'config', 'slider_crank_scene.yaml'))
JOINTS = ['crank_joint', 'rod_joint', 'slider_joint']
REACTIONS = JOINTS + ['wrist_pin']
# Closed forms of forces of some 10 N against a system of equations.
CLOSED_FORM = 1e-12
STEP = 10000000  # ns
GRAVITY = np.array([0, -9.81])
# Of the slider-crank's URDF: lengths, m, and masses, kg.
R, L = 0.10, 0.30
MASSES = {'crank': 0.80, 'rod': 0.50, 'slider': 0.60}


def unit(angle):
    return np.array([math.cos(angle), math.sin(angle)])


def normal(angle):
    return np.array([-math.sin(angle), math.cos(angle)])


class SliderCrank:
    """The closed form of a slider-crank's motion and forces, from the crank's motion."""

    def __init__(self, angle, rate, acceleration):
        rod = -math.asin(R / L * math.sin(angle))
        # d(rod)/d(angle) and its derivative
        p = -R * math.cos(angle) / (L * math.cos(rod))
        pp = (R * math.sin(angle) + L * math.sin(rod) * p * p) / (L * math.cos(rod))
        slope = {'crank': 0.03 * normal(angle),
                 'rod': R * normal(angle) + 0.11 * p * normal(rod),
                 'slider': R * normal(angle) + L * p * normal(rod)}
        bend = {'crank': -0.03 * unit(angle),
                'rod': -R * unit(angle) + 0.11 * (pp * normal(rod) - p * p * unit(rod)),
                'slider': -R * unit(angle) + L * (pp * normal(rod) - p * p * unit(rod))}
        accelerations = {body: slope[body] * acceleration + bend[body] * rate ** 2
                         for body in slope}
        turn = p * acceleration + pp * rate ** 2
        slide = R * math.cos(angle) + L * math.cos(rod)
        self.q = {'crank_joint': angle, 'rod_joint': rod - angle, 'slider_joint': slide}
        self.qd = {'crank_joint': rate, 'rod_joint': (p - 1) * rate,
                   'slider_joint': slope['slider'][0] * rate}
        self.qdd = {'crank_joint': acceleration, 'rod_joint': turn - acceleration,
                    'slider_joint': accelerations['slider'][0]}
        # Virtual work over a turn of the crank.
        self.torque = sum(MASSES[body] * (accelerations[body] - GRAVITY) @ slope[body]
                          for body in slope) + 0.0012 * acceleration + 0.0045 * turn * p
        # The rod's force on the slider: along x it moves the slider, along y it holds the rod's
        # moments about the crank pin.
        load = MASSES['rod'] * (accelerations['rod'] - GRAVITY)
        x = MASSES['slider'] * accelerations['slider'][0]
        turning = 0.0045 * turn + 0.11 * (unit(rod)[0] * load[1] - unit(rod)[1] * load[0])
        y = (L * unit(rod)[1] * x - turning) / (L * unit(rod)[0])
        self.pin = [x, y]
        self.slide_slope = slope['slider'][0]


def by_name(message, values):
    return dict(zip(message.name, values))


class LoopTest(NodeTest):
    """The node with a slider-crank, or another mechanism."""

    def start(self, *topics, robot=SLIDER_CRANK, scene=None, parameters=None):
        kinds = {'effort': JointState, 'reactions': MultiDOFJointState,
                 'determinacy': DiagnosticArray, 'motion': JointTrajectory, 'joint_trajectory': JointTrajectory}
        scene = SLIDER_CRANK_SCENE if scene is None else scene
        self.node = Node(self, robot, {'scene': scene, **(parameters or {})})
        self.states = self.node.feed('joint_states', JointState)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.recorders = {topic: self.node.record(topic, kinds.get(topic, WrenchStamped))
                          for topic in topics}
        self.node.wait_for_plan(*topics)

    def status(self, condition, what, from_the_start=False):
        """The next report that meets the condition on its status."""
        seen = 0 if from_the_start else len(self.node.statuses())
        return wait_until(
            lambda: next((s for s in self.node.statuses()[seen:] if condition(s)), None),
            lambda: '%s; the last report: %s' % (what, self.node.statuses()[-1:]))

    def assertMatches(self, message, expected, tolerance):
        """A message of ~effort of the slider-crank."""
        self.assertEqual(message.name, JOINTS)
        for actual, wanted in ((message.position, expected.q), (message.velocity, expected.qd)):
            self.assertClose(actual, [wanted[name] for name in JOINTS], tolerance, 'motion')
        self.assertClose(message.effort, [expected.torque, 0, 0], tolerance, 'efforts')
