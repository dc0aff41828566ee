#!/usr/bin/python3
"""Joints that turn freely beside closures and springs, live: found by the closures, or told by messages."""
import math

from geometry_msgs.msg import Transform, Vector3
import numpy as np
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from closed_loops import LoopTest, SLIDER_CRANK_SCENE, SliderCrank
from node_free_joints_test import FRAME, SCENE, FreeJoints, attitude, ball_efforts, wrist
from node_under_test import EPOCH, joint_state, ros_time, run, trajectory_point

MS = 1000000
# The slider-crank with a ball between crank and rod: the pin at the slider keeps the rod in its plane.
WITH_BALL = dict(SLIDER_CRANK_SCENE, joint_types=[{'name': 'rod_joint', 'type': 'spherical'}],
                 reactions='none')
NAMES = ['crank_joint', 'rod_joint.rx', 'rod_joint.ry', 'rod_joint.rz', 'slider_joint']
# Closed forms of some N m against a system of equations, whose loops are closed to 1e-9.
CLOSED_FORM = 1e-8


def crank(ns):
    """More than a turn and a half in two seconds."""
    t = (ns - EPOCH) / 1e9
    return SliderCrank(0.3 + 2 * t + 1.5 * t * t, 2 + 3 * t, 3.0)


class FoundBalls(LoopTest):
    def check(self, message):
        right = crank(message.header.stamp.to_nsec())
        values = dict(zip(message.name, message.effort))
        self.assertEqual(list(values), NAMES)
        self.assertClose([values[name] for name in NAMES], [right.torque, 0, 0, 0, 0], CLOSED_FORM,
                         'efforts at %s' % message.header.stamp)
        slide = dict(zip(message.name, message.position))['slider_joint']
        self.assertClose([slide], [right.q['slider_joint']], CLOSED_FORM, 'slide')

    def test_joint_states_of_the_crank_alone(self):
        self.start('effort', scene=WITH_BALL)
        for i in range(500):
            ns = EPOCH + i * 4 * MS
            right = crank(ns)
            self.states.publish(joint_state(ns, {'crank_joint': right.q['crank_joint']},
                                            {'crank_joint': right.qd['crank_joint']}))
        messages = self.recorders['effort'].wait(450)
        for message in messages[::7]:
            self.check(message)
        turned = (messages[-1].position[0] - messages[0].position[0]) / math.pi
        self.assertGreater(turned, 2)
        self.assertEqual(self.node.diagnostics()['dropped'], '0')

    def test_trajectories_of_the_crank_alone(self):
        self.start('effort', scene=WITH_BALL)
        message = JointTrajectory(joint_names=['crank_joint'])
        message.header.stamp = ros_time(EPOCH)
        for i in range(100):
            right = crank(EPOCH + i * 20 * MS)
            message.points.append(trajectory_point(i * 20 * MS, ['crank_joint'],
                                                   (right.q, right.qd, right.qdd)))
        self.trajectories.publish(message)
        for found in self.recorders['effort'].wait(100):
            self.check(found)
        # The angles of the ball are no joints of a trajectory, and so are not looked at.
        message.joint_names = ['crank_joint', 'rod_joint.rz']
        for point in message.points:
            for values in (point.positions, point.velocities, point.accelerations):
                values.append(9)
        self.trajectories.publish(message)
        for found in self.recorders['effort'].wait(200)[100:]:
            self.check(found)
        self.assertEqual(self.node.diagnostics()['dropped'], '0')


# A spring without weight from the base to the end of the arm on the ball.
STIFFNESS, LENGTH = 40.0, 0.2
ABOVE, END = np.array([0.1, 0.2, 1.6]), np.array([0.0, 0.0, 0.4])
WITH_SPRING = dict(SCENE, springs=[{
    'name': 'spring', 'link_a': 'base', 'at_a': ABOVE.tolist(), 'link_b': 'arm',
    'at_b': END.tolist(), 'stiffness': STIFFNESS, 'rest_length': LENGTH}])


def sprung_efforts(t):
    """Those of the ball without the spring, less the spring's moment about it in the arm's axes."""
    turn = FRAME @ attitude(t)
    way = ABOVE - np.array([0.2, 0.1, 0.5]) - turn @ END
    pull = STIFFNESS * (1 - LENGTH / np.linalg.norm(way)) * way
    efforts = np.array(ball_efforts(t))
    efforts[:3] -= np.cross(END, turn.T @ pull)
    return efforts


class SprungBalls(FreeJoints):
    def test_a_ball_beside_a_spring(self):
        self.start(scene=WITH_SPRING)
        self.node.wait_for_plan('effort')
        self.send(1000)
        messages = self.efforts.wait(900)
        self.assertEqual(messages[0].name, ['ball.rx', 'ball.ry', 'ball.rz', 'wrist'])
        chosen = [m for m in messages if m.header.stamp.to_nsec() > EPOCH + 1200 * MS][::11]
        self.assertGreater(len(chosen), 20)
        worst = pulled = 0
        for message in chosen:
            t = (message.header.stamp.to_nsec() - EPOCH) / 1e9
            right = sprung_efforts(t)
            worst = max(worst, np.abs(np.array(message.effort) - right).max())
            pulled = max(pulled, np.abs(right - ball_efforts(t)).max())
        print('beside a spring: %g of %g N m by the spring' % (worst, pulled))
        self.assertGreater(pulled, 3)
        self.assertLess(worst, 0.005)
        self.assertEqual(self.node.diagnostics()['dropped'], '0')

    def test_trajectories_do_not_tell_its_orientation(self):
        self.start(scene=WITH_SPRING)
        self.node.wait_for_plan('effort')
        message = JointTrajectory(joint_names=['wrist'])
        message.header.stamp = ros_time(EPOCH)
        message.points = [trajectory_point(0, ['wrist'], ({'wrist': 0}, {'wrist': 0}, {'wrist': 0}))]
        self.node.feed('joint_trajectory', JointTrajectory).publish(message)
        values = self.node.wait_for_count('dropped: orientation', 1)
        self.assertIn("joint 'ball' turns freely", values['last drop'])

    def test_of_a_gap_what_came_before_it_is_held(self):
        """Both, with a spring and without: at rest where it was, whatever comes after the gap."""
        for scene in (SCENE, WITH_SPRING):
            with self.subTest(springs='springs' in scene):
                self.start(scene=scene, parameters={'hold_after': 0.1})
                self.node.wait_for_plan('effort')
                states = self.node.feed('joint_states', JointState)
                for i in range(450):
                    ns = EPOCH + i * 2 * MS
                    # From 0.2 to 0.7 s there is none, and then it is elsewhere.
                    if i % 5 == 0 and not 100 <= i < 350:
                        message = self.state(ns)
                        if i >= 350:
                            message.transforms = [Transform(translation=Vector3(), rotation=self.state(
                                EPOCH + 2000 * MS).transforms[0].rotation)]
                        self.turns.publish(message)
                    states.publish(joint_state(ns, {'wrist': 0.0}, {'wrist': 0.0}))
                    if i % 10 == 9:  # less than the lag
                        self.node.wait_for_count('joint states received', i + 1)
                messages = {m.header.stamp.to_nsec(): m for m in self.efforts.wait(400)}
                held = [ns for ns in messages if EPOCH + 320 * MS < ns < EPOCH + 698 * MS]
                self.assertGreater(len(held), 150)
                turn = FRAME @ attitude(0.19)
                right = sum(np.cross(at, turn.T @ np.array([0, 0, 9.81 * mass]))
                            for mass, at in ((2, [0.1, -0.2, 0.3]), (1, [0, 0, 0.4])))
                if scene is WITH_SPRING:
                    right = right + sprung_efforts(0.19)[:3] - ball_efforts(0.19)[:3]
                for ns in held:
                    self.assertClose(messages[ns].effort[:3], right, 1e-6, 'held at %d' % ns)


# The tests of the other file run there.
for name in [name for name in dir(FreeJoints) if name.startswith('test_')]:
    setattr(SprungBalls, name, None)

if __name__ == '__main__':
    assert wrist(0)[0] == 0
    run(FoundBalls, SprungBalls)
