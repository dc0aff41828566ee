#!/usr/bin/python3
"""Motions of mechanisms with closed loops in the node: completed where they give actuated joints
only, checked where they give all."""
import math

from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from closed_loops import (CLOSED_FORM, JOINTS, REACTIONS, SLIDER_CRANK_SCENE, STEP,
                          LoopTest, SliderCrank, by_name)
from node_under_test import (EPOCH, Node, Polynomials, joint_state, ros_time, run, trajectory_point,
                             vector, wait_until)

# The estimator's rounding on a cubic, in accelerations of links of some kg.
ESTIMATED = 1e-8
# The crank's angle from the place of the slider, away from the dead centres.
BY_SLIDER = 1e-11
# A few roundings to a link, relative to the sums of magnitudes.
SOUND = 1e-13
LAG = 5  # samples: ~estimator/lag of 0.05 s
# A boom on a pin that a ram raises, in the plane of x and z.
BOOM = """<robot name="boom"><link name="frame"/>
  <link name="arm"><inertial><mass value="2"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="cylinder"/><link name="rod"/>
  <joint name="arm_pin" type="continuous"><parent link="frame"/><child link="arm"/>
    <axis xyz="0 1 0"/></joint>
  <joint name="cylinder_pin" type="continuous"><parent link="frame"/><child link="cylinder"/>
    <origin xyz="-0.4 0 -0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="ram" type="prismatic"><parent link="cylinder"/><child link="rod"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="3" effort="1" velocity="1"/></joint></robot>"""
# The ram does not reach the boom from where the scene places it.
BOOM_SCENE = {'actuated': ['ram'], 'assembly': [{'name': 'ram', 'position': 5}], 'closures': [
    {'name': 'eye', 'type': 'revolute', 'parent': {'link': 'rod', 'rpy': [-math.pi / 2, 0, 0]},
     'child': {'link': 'arm', 'xyz': [1.1, 0, 0], 'rpy': [-math.pi / 2, 0, 0]}}]}
CRANK = Polynomials(crank_joint=(0.4, 2.0, 1.5, -0.8))


def at(ns):
    q, qd, qdd = CRANK(ns)
    return SliderCrank(q['crank_joint'], qd['crank_joint'], qdd['crank_joint'])


def boom_at(raised):
    x, z = 1.1 * math.cos(raised) + 0.4, 1.1 * math.sin(raised) + 0.3
    return {'arm_pin': -raised, 'cylinder_pin': -math.atan2(z, x), 'ram': math.hypot(x, z)}


class LoopMotions(LoopTest):
    def test_joint_states_of_the_crank_alone(self):
        self.start('effort', 'reactions', 'reaction/wrist_pin')
        stamps = [EPOCH + STEP * i for i in range(60)]
        for ns in stamps:
            q, qd, _ = CRANK(ns)
            self.states.publish(joint_state(ns, q, qd))
        stamps = stamps[:-LAG]
        efforts, reactions, wrenches = (self.recorders[topic].wait(len(stamps)) for topic in
                                        ('effort', 'reactions', 'reaction/wrist_pin'))
        for messages in (efforts, reactions, wrenches):
            self.assertStamps(messages, stamps)
        for ns, effort, reaction, wrench in zip(stamps, efforts, reactions, wrenches):
            expected = at(ns)
            self.assertMatches(effort, expected, ESTIMATED)
            self.assertEqual(reaction.joint_names, REACTIONS)
            force = vector(reaction.wrench[3].force)
            self.assertClose(force[:2], expected.pin, ESTIMATED, 'force at the pin')
            self.assertClose(vector(reaction.transforms[3].translation),
                             [expected.q['slider_joint'], 0, 0], ESTIMATED, 'place of the pin')
            # The slider does not turn, so the child frame's axes are the root's.
            self.assertEqual(wrench.header.frame_id, 'wrist_pin')
            self.assertClose(vector(wrench.wrench.force), force, CLOSED_FORM, 'axes')
        values = self.node.wait_for_count('samples computed', len(stamps))
        self.assertEqual(values['passive joints'], 'from the closures')
        self.assertEqual(values['joints waited for'], 'none')
        self.assertEqual(values['samples that violate a loop'], '0')
        self.assertLess(float(values['residual, largest (relative)']), 1e-9)
        self.assertEqual((values['rank'], values['redundant constraints']), ('3', '3'))

    def test_certificates_and_cross_check(self):
        self.start('reaction/wrist_pin', 'reactions',
                   parameters={'certificates': True, 'cross_check_rate': 1000})
        stamps = [EPOCH + STEP * i for i in range(30)]
        for ns in stamps:
            q, qd, _ = CRANK(ns)
            self.states.publish(joint_state(ns, q, qd))
        self.assertStamps(self.recorders['reaction/wrist_pin'].wait(len(stamps) - LAG), stamps[:-LAG])
        kinds = ['certificate: %s (largest, relative)' % kind
                 for kind in ('power', 'ground force', 'ground moment')]
        kinds.append('cross-check, largest difference (relative)')
        values = self.node.diagnostics(lambda values: all(kind in values for kind in kinds),
                                       'certificates and a cross-check')
        self.assertEqual(values['certificates'], 'on')
        self.assertEqual(values['cross-check'], 'up to 1000 a second')
        self.assertGreater(float(values[kinds[-1]]), 0)
        self.assertRegex(values['cross-check, where'],
                         '^(effort of|force at|moment at) (%s)$' % '|'.join(JOINTS + ['ground']))
        for kind in kinds:
            self.assertLess(float(values[kind]), SOUND, kind)
        for status in self.node.statuses():
            self.assertEqual(status.level, DiagnosticStatus.OK, status)

    def test_full_joint_states_are_checked_and_not_altered(self):
        self.start('effort')
        stamps = [EPOCH + STEP * i for i in range(30)]
        for ns in stamps:
            motion = at(ns)
            self.states.publish(joint_state(ns, motion.q, motion.qd))
        messages = self.recorders['effort'].wait(len(stamps) - LAG)
        self.assertStamps(messages, stamps[:-LAG])
        values = self.node.wait_for_count('samples computed', len(stamps) - LAG)
        self.assertEqual(values['passive joints'], 'given')
        # The estimates of the joints do not know of the closures.
        self.assertLess(float(values['residual.position.wrist_pin']), 1e-6)

    def test_a_loop_that_is_violated_is_a_warning(self):
        self.start('effort', parameters={'estimator': {'acceleration': 'zero'}})
        still = SliderCrank(0.4, 0, 0)
        self.states.publish(joint_state(EPOCH, still.q, dict.fromkeys(JOINTS, 0)))
        self.assertMatches(self.recorders['effort'].wait(1)[0], still, CLOSED_FORM)
        values = self.node.wait_for_count('samples computed', 1)
        self.assertEqual(values['samples that violate a loop'], '0')
        shifted = dict(still.q, slider_joint=still.q['slider_joint'] + 0.001)
        self.states.publish(joint_state(EPOCH + STEP, shifted, dict.fromkeys(JOINTS, 0)))
        message = self.recorders['effort'].wait(2)[1]
        self.assertEqual(by_name(message, message.position), shifted)
        status = self.node.wait_for_status('positions violate')
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn("positions violate closure 'wrist_pin' by 0.001 m or rad", status.message)
        self.assertIn(self.node.name + '/loop_tolerance is 1e-06', status.message)
        self.assertEqual(self.node.wait_for_count('samples that violate a loop', 1)['dropped'], '0')
        # Some way from there again, in time.
        self.states.publish(joint_state(EPOCH + 2 * STEP, still.q, {**still.qd, 'rod_joint': 0.5}))
        self.node.wait_for_status("velocities violate closure 'wrist_pin' by 0.15 m/s")
        self.assertEqual(len(self.recorders['effort'].wait(3)), 3)

    def test_trajectories(self):
        for parameters in ({}, {'trajectory_rate': 1000}):
            self.start('effort', 'joint_trajectory', parameters=parameters)
            for sent, names in enumerate((['crank_joint'], JOINTS), 1):
                times = [EPOCH + STEP * i for i in range(150)]
                message = JointTrajectory(joint_names=names)
                message.header.stamp = ros_time(EPOCH)
                for ns in times:
                    motion = at(ns)
                    message.points.append(trajectory_point(
                        ns - EPOCH, names, (motion.q, motion.qd, motion.qdd)))
                self.trajectories.publish(message)
                results = self.recorders['effort'].wait(150 * sent)[-150:]
                self.assertStamps(results, times)
                filled = self.recorders['joint_trajectory'].wait(sent)[-1]
                self.assertEqual(filled.joint_names, names)
                for ns, result, point in zip(times, results, filled.points):
                    self.assertMatches(result, at(ns), CLOSED_FORM)
                    self.assertClose(point.effort, [at(ns).torque, 0, 0][:len(names)], CLOSED_FORM,
                                     'filled in')
            values = self.node.wait_for_count('trajectory points computed', 300)
            self.assertEqual(values['samples that violate a loop'], '0')

    def test_free_motion(self):
        # Nothing drives the crank: what its motion demands is no effort, and is not filled in as one.
        scene = dict(SLIDER_CRANK_SCENE, actuated=[], free_motion=True, given=['crank_joint'])
        self.start('effort', 'joint_trajectory', scene=scene)
        self.assertIn('free motions: residual.motion.crank_joint', self.node.output())
        times = [EPOCH + STEP * i for i in range(50)]
        message = JointTrajectory(joint_names=['crank_joint'])
        message.header.stamp = ros_time(EPOCH)
        for ns in times:
            motion = at(ns)
            message.points.append(trajectory_point(
                ns - EPOCH, ['crank_joint'], (motion.q, motion.qd, motion.qdd)))
        self.trajectories.publish(message)
        for ns, result in zip(times, self.recorders['effort'].wait(len(times))):
            self.assertEqual(result.name, ['residual.motion.crank_joint'] + JOINTS[1:] +
                             ['crank_joint'])
            self.assertClose(result.effort, [at(ns).torque, 0, 0, 0], CLOSED_FORM, 'residual')
            # tf follows it by its own name.
            self.assertEqual([result.position[3], result.velocity[3]],
                             [result.position[0], result.velocity[0]])
        filled = self.recorders['joint_trajectory'].wait(1)[0]
        self.assertEqual([list(point.effort) for point in filled.points], [[0]] * len(times))

    def test_a_trajectory_without_derivatives(self):
        self.start('effort')
        times = [EPOCH + STEP * i for i in range(50)]
        for sent, names in enumerate((['crank_joint'], JOINTS), 1):
            message = JointTrajectory(joint_names=names)
            message.header.stamp = ros_time(EPOCH)
            message.points = [trajectory_point(ns - EPOCH, names, (at(ns).q,), 1) for ns in times]
            self.trajectories.publish(message)
            for result in self.recorders['effort'].wait(50 * sent)[-50:]:
                angle, rate = result.position[0], result.velocity[0]
                self.assertClose(result.velocity, list(SliderCrank(angle, rate, 0).qd.values()),
                                 CLOSED_FORM, 'velocities')
        values = self.node.wait_for_count('trajectory points computed', 100)
        self.assertEqual(values['samples that violate a loop'], '0')
        self.assertIn('passive joints from the closures', ''.join(self.node.lines('INFO')))

    def test_trajectories_that_give_a_part_of_the_passive_joints(self):
        self.start('effort')
        message = JointTrajectory(joint_names=['crank_joint', 'slider_joint'])
        message.header.stamp = ros_time(EPOCH)
        still = SliderCrank(0.4, 0, 0)
        message.points = [trajectory_point(0, message.joint_names, (still.q, still.qd, still.qdd))]
        self.trajectories.publish(message)
        values = self.node.wait_for_count('dropped: passive joints', 1)
        self.assertIn("too much is given: each of 'crank_joint', 'slider_joint' follows from the rest; leave one "
                      'out, or give all joints and nothing else', values['last drop'])

    def test_trajectories_of_a_passive_joint(self):
        self.start('effort', parameters={'estimator': {'acceleration': 'zero'}})
        self.states.publish(joint_state(EPOCH, {'crank_joint': 0.4}))
        self.recorders['effort'].wait(1)
        zero = {'slider_joint': 0}
        moved = [SliderCrank(angle, 0, 0) for angle in (0.5, 0.9, 1.3)]
        message = JointTrajectory(joint_names=['slider_joint'])
        message.header.stamp = ros_time(EPOCH)
        message.points = [trajectory_point(STEP * i, ['slider_joint'], (still.q, zero, zero))
                          for i, still in enumerate(moved)]
        self.trajectories.publish(message)
        for result, still in zip(self.recorders['effort'].wait(4)[1:], moved):
            self.assertMatches(result, still, BY_SLIDER)

    def test_joint_states_of_a_passive_joint(self):
        scene = dict(SLIDER_CRANK_SCENE, given=['slider_joint'],
                     assembly=[{'name': 'crank_joint', 'position': 0.8},
                               {'name': 'rod_joint', 'position': -1.04},
                               {'name': 'slider_joint', 'position': 0.35}])
        self.start('effort', scene=scene, parameters={'estimator': {'acceleration': 'zero'}})
        for i, angle in enumerate((0.8, 0.6, 0.9)):
            expected = SliderCrank(angle, 0, 0)
            self.states.publish(joint_state(
                EPOCH + STEP * i, {'slider_joint': expected.q['slider_joint']}, {'slider_joint': 0}))
            self.assertMatches(self.recorders['effort'].wait(i + 1)[-1], expected, BY_SLIDER)
        values = self.node.wait_for_count('samples computed', 3)
        self.assertEqual(values['passive joints'], 'from the closures')
        self.assertEqual(values['joints waited for'], 'none')

    def test_joint_states_that_do_not_close_the_loops_are_no_start(self):
        self.start('effort', parameters={'estimator': {'acceleration': 'zero'}})
        still = SliderCrank(0.4, 0, 0)
        # Far from closed, near the branch on which the rod points back.
        turned_over = {'crank_joint': 0.4, 'rod_joint': 2.8, 'slider_joint': -0.2}
        for i in range(5):
            self.states.publish(joint_state(EPOCH + STEP * i, turned_over, dict.fromkeys(JOINTS, 0)))
        self.recorders['effort'].wait(5)
        self.node.wait_for_line('WARN', 'leave closure')
        message = JointTrajectory(joint_names=['crank_joint'])
        message.header.stamp = ros_time(EPOCH)
        message.points = [trajectory_point(0, ['crank_joint'], (still.q, still.qd, still.qdd))]
        self.trajectories.publish(message)
        self.assertMatches(self.recorders['effort'].wait(6)[-1], still, CLOSED_FORM)
        warnings = [line for line in self.node.lines('WARN') if 'leave closure' in line]
        self.assertEqual(len(warnings), 1, warnings)
        self.assertRegex(warnings[0], "the positions leave closure 'wrist_pin' open by 0\\.\\d+ m or rad, "
                                      '.* relative, more than 0.01: .* but from the assembly')

    def test_joint_states_say_where_loops_start(self):
        self.node = Node(self, BOOM, {'scene': BOOM_SCENE, 'start_patience': 60,
                                      'estimator': {'acceleration': 'zero'}})
        efforts = self.node.record('effort', JointState)
        self.node.wait_for_line('WARN', 'waiting up to')
        states = self.node.feed('joint_states', JointState)
        states.publish(joint_state(EPOCH, boom_at(0.9)))
        self.node.wait_for_plan('effort')
        wait_until(lambda: states.get_num_connections() > 0, 'the node')
        # The ram alone, on the branch that the joint states have shown.
        moved = boom_at(1.1)
        states.publish(joint_state(EPOCH + STEP, {'ram': moved['ram']}, {'ram': 0}))
        result = efforts.wait(1)[0]
        self.assertClose(result.position, [moved[name] for name in result.name], BY_SLIDER, 'positions')

    def test_loops_that_joint_states_do_not_close_either(self):
        self.node = Node(self, BOOM, {'scene': BOOM_SCENE, 'start_patience': 0.5})
        self.assertEqual(self.node.wait(), 1)
        self.assertIn("'eye' cannot be assembled from the given start", self.node.lines('FATAL')[0])

    def test_a_part_of_the_passive_joints_is_ignored(self):
        self.start('effort', parameters={'estimator': {'acceleration': 'zero'}})
        still = SliderCrank(0.4, 0, 0)
        wrong = {'crank_joint': 0.4, 'slider_joint': 7}
        self.states.publish(joint_state(EPOCH, wrong))
        self.assertMatches(self.recorders['effort'].wait(1)[0], still, CLOSED_FORM)
        self.node.wait_for_line(
            'WARN', 'joints slider_joint are given, but not rod_joint: they are ignored')
        self.states.publish(joint_state(EPOCH + STEP, {'rod_joint': 7}))
        self.node.diagnostics(lambda values: values['passive joints'] == 'given', 'all of them')


if __name__ == '__main__':
    run(LoopMotions)
