#!/usr/bin/python3
"""Motions of mechanisms with closed loops in the node: completed where they give actuated joints
only, checked where they give all."""
from diagnostic_msgs.msg import DiagnosticStatus
from trajectory_msgs.msg import JointTrajectory

from closed_loops import (CLOSED_FORM, JOINTS, REACTIONS, STEP, LoopTest, SliderCrank,
                          by_name)
from node_under_test import (EPOCH, Polynomials, joint_state, ros_time, run, trajectory_point,
                             vector, wait_until)

# The estimator's rounding on a cubic, in accelerations of links of some kg.
ESTIMATED = 1e-8
# A few roundings to a link, relative to the sums of magnitudes.
SOUND = 1e-13
LAG = 5  # samples: ~estimator/lag of 0.05 s
CRANK = Polynomials(crank_joint=(0.4, 2.0, 1.5, -0.8))


def at(ns):
    q, qd, qdd = CRANK(ns)
    return SliderCrank(q['crank_joint'], qd['crank_joint'], qdd['crank_joint'])


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
        status = self.status(lambda s: 'violate' in s.message, 'the violation')
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn("positions violate closure 'wrist_pin' by 0.001 m or rad", status.message)
        self.assertIn(self.node.name + '/loop_tolerance is 1e-06', status.message)
        self.assertEqual(self.node.wait_for_count('samples that violate a loop', 1)['dropped'], '0')
        # Some way from there again, in time.
        self.states.publish(joint_state(EPOCH + 2 * STEP, still.q, {**still.qd, 'rod_joint': 0.5}))
        self.status(lambda s: "velocities violate closure 'wrist_pin' by 0.15 m/s" in s.message,
                    'the velocities')
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
        self.assertIn("'slider_joint' are given, but not 'rod_joint': give all joints, or the actuated ones only",
                      values['last drop'])

    def test_a_part_of_the_passive_joints_is_ignored(self):
        self.start('effort', parameters={'estimator': {'acceleration': 'zero'}})
        still = SliderCrank(0.4, 0, 0)
        wrong = {'crank_joint': 0.4, 'slider_joint': 7}
        self.states.publish(joint_state(EPOCH, wrong))
        self.assertMatches(self.recorders['effort'].wait(1)[0], still, CLOSED_FORM)
        wait_until(lambda: self.node.lines('WARN'), 'a warning')
        self.assertIn('passive joints slider_joint are given, but not rod_joint: they are ignored',
                      self.node.lines('WARN')[0])
        self.states.publish(joint_state(EPOCH + STEP, {'rod_joint': 7}))
        self.node.diagnostics(lambda values: values['passive joints'] == 'given', 'all of them')


if __name__ == '__main__':
    run(LoopMotions)
