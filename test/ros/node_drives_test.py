#!/usr/bin/python3
"""What moves as functions of time in the node, and in bags of what it was told."""
import os
import shutil
import subprocess
import tempfile

import numpy
import rosbag
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory
import yaml

from closed_loops import JOINTS, SLIDER_CRANK, SLIDER_CRANK_SCENE, STEP, LoopTest, SliderCrank, by_name
from node_under_test import (EPOCH, Node, NodeTest, Polynomials, executable, joint_state, read,
                             ros_time, run, trajectory_point)
from rigid_bodies import RigidBodies

ARM = read('data', 'arm.urdf')
LAG = 5  # samples: ~estimator/lag of 0.05 s
# The law is exact; what follows from it is found to some roundings.
EXACT = 1e-11
# The estimator's rounding on a cubic.
ESTIMATED = 1e-8
COEFFICIENTS = {'shoulder': (0.3, -0.8, 1.1), 'elbow': (1.0, 0.9, -0.6, 1.3), 'slide': (0.05, 0.2)}
CRANK = (0.4, 2.0, 1.5, -0.8)
# A boom that a cylinder lifts.
LIFT = """<robot name="lift"><link name="frame"/>
  <link name="boom"><inertial><origin xyz="0.8 0 0"/><mass value="40"/>
    <inertia ixx="0.2" iyy="3" izz="3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="pin" type="continuous"><parent link="frame"/><child link="boom"/>
    <axis xyz="0 1 0"/></joint></robot>"""
LIFT_SCENE = {'actuated': [], 'cylinders': [
    {'name': 'ram', 'link_a': 'frame', 'at_a': [0.4, 0, -0.6], 'link_b': 'boom',
     'at_b': [0.9, 0, 0]}]}


def polynomial(name, coefficients):
    return {'name': name, 'law': 'polynomial', 'coefficients': list(coefficients)}


def driven(scene, *drives):
    return dict(scene, drives=list(drives))


def only(values, *names):
    return {name: values[name] for name in names}


class DrivenJoints(NodeTest):
    """An open chain with a driven shoulder."""

    def setUp(self):
        self.bodies = RigidBodies(ARM)

    def start(self, drive, parameters=None):
        self.node = Node(self, ARM, dict({'scene': {'drives': [drive]}, 'late_threshold': 1000},
                                         **(parameters or {})))
        self.states = self.node.feed('joint_states', JointState)
        self.trajectories = self.node.feed('joint_trajectory', JointTrajectory)
        self.efforts = self.node.record('effort', JointState)
        self.node.wait_for_plan('effort')

    def publish_states(self, motion, start=EPOCH, more=lambda q: {}):
        """Joint states of what is not driven, and of `more`. Returns their stamps."""
        stamps = [start + STEP * i for i in range(40)]
        for ns in stamps:
            q, qd, _ = motion(ns)
            self.states.publish(joint_state(ns, dict(only(q, 'elbow', 'slide'), **more(q)), qd))
        return stamps

    def test_joint_states_lack_what_is_driven(self):
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']))
        motion = Polynomials(**COEFFICIENTS)
        stamps = self.publish_states(motion)
        messages = self.efforts.wait(len(stamps) - LAG)
        self.assertStamps(messages, stamps[:-LAG])
        for ns, message in zip(stamps, messages):
            self.assertEffort(message, self.bodies, motion(ns), ESTIMATED)
            # To the last bit but one: nothing is estimated of it.
            self.assertClose([by_name(message, message.position)['shoulder']],
                             [motion(ns)[0]['shoulder']], 1e-15, 'the law')
        self.assertEqual(self.node.diagnostics()['joints waited for'], 'none')
        # An observer would need the joint's measured motion at the newest joint state.
        self.assertIn('external_effort is not offered: momentum observer: what has a drive',
                      self.node.output())

    def test_what_joint_states_say_of_it_is_not_used(self):
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']))
        motion = Polynomials(**COEFFICIENTS)
        stamps = self.publish_states(motion, more=lambda q: {'shoulder': 17 - q['shoulder']})
        messages = self.efforts.wait(len(stamps) - LAG)
        self.assertStamps(messages, stamps[:-LAG])
        for ns, message in zip(stamps, messages):
            self.assertEffort(message, self.bodies, motion(ns), ESTIMATED)

    def test_time_begins_anew_when_stamps_go_back(self):
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']))
        back = EPOCH - 10000000000
        for start in (EPOCH, back):
            motion = Polynomials(start, **COEFFICIENTS)
            seen = len(self.efforts.messages())
            stamps = self.publish_states(motion, start)
            messages = self.efforts.wait(seen + len(stamps) - LAG)[seen:]
            self.assertStamps(messages, stamps[:-LAG])
            for ns, message in zip(stamps, messages):
                self.assertEffort(message, self.bodies, motion(ns), ESTIMATED)

    def test_trajectories_lack_it_too_and_time_may_start_at_a_stamp(self):
        start = 1600000000
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']), {'drive_start': start})
        motion = Polynomials(start * 1000000000, **COEFFICIENTS)
        names = ['elbow', 'slide']
        message = JointTrajectory(joint_names=names)
        message.header.stamp = ros_time(EPOCH)
        offsets = [STEP * i for i in range(30)]
        for offset in offsets:
            message.points.append(trajectory_point(offset, names, motion(EPOCH + offset)))
        self.trajectories.publish(message)
        messages = self.efforts.wait(len(offsets))
        self.assertStamps(messages, [EPOCH + offset for offset in offsets])
        for offset, effort in zip(offsets, messages):
            self.assertEffort(effort, self.bodies, motion(EPOCH + offset), EXACT)

    def test_time_begins_anew_with_a_trajectory_before_its_zero(self):
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']))
        names = ['elbow', 'slide']
        for start in (EPOCH, EPOCH - 10000000000):
            motion = Polynomials(start, **COEFFICIENTS)
            seen = len(self.efforts.messages())
            message = JointTrajectory(joint_names=names)
            message.header.stamp = ros_time(start)
            for i in range(5):
                message.points.append(trajectory_point(STEP * i, names, motion(start + STEP * i)))
            self.trajectories.publish(message)
            for i, effort in enumerate(self.efforts.wait(seen + 5)[seen:]):
                self.assertEffort(effort, self.bodies, motion(start + STEP * i), EXACT)

    def test_time_begins_with_the_first_result(self):
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']))
        motion = Polynomials(**COEFFICIENTS)
        for i in range(-30, 0):
            self.states.publish(joint_state(EPOCH + STEP * i, {'elbow': COEFFICIENTS['elbow'][0]}))
        stamps = self.publish_states(motion)
        messages = self.efforts.wait(len(stamps) - LAG)
        self.assertStamps(messages, stamps[:-LAG])
        for ns, message in zip(stamps, messages):
            self.assertClose([by_name(message, message.position)['shoulder']],
                             [motion(ns)[0]['shoulder']], 1e-15, 'the law')

    def test_a_law_is_exact(self):
        drives = [polynomial(name, COEFFICIENTS[name]) for name in COEFFICIENTS]
        self.start(drives[0], {'scene': {'drives': drives}})
        deviations = self.node.record('effort_deviation', JointState)
        self.node.wait_for_plan('effort', 'effort_deviation')
        random = numpy.random.default_rng(5)
        for i in range(60):
            self.states.publish(joint_state(EPOCH + STEP * i,
                                            {'elbow': 1 + 1e-3 * random.standard_normal()}))
        for message in deviations.wait(40):
            self.assertEqual(list(message.effort), [0, 0, 0])

    def test_samples_between_points_of_trajectories(self):
        self.start(polynomial('shoulder', COEFFICIENTS['shoulder']), {'trajectory_sampling': 200})
        motion = Polynomials(**COEFFICIENTS)
        names = ['elbow', 'slide']
        message = JointTrajectory(joint_names=names)
        message.header.stamp = ros_time(EPOCH)
        for i in range(10):
            message.points.append(trajectory_point(STEP * i, names, motion(EPOCH + STEP * i)))
        self.trajectories.publish(message)
        messages = self.efforts.wait(19)
        self.assertStamps(messages, [EPOCH + STEP // 2 * i for i in range(19)])
        for effort in messages:
            self.assertEffort(effort, self.bodies, motion(effort.header.stamp.to_nsec()), ESTIMATED)

    def test_a_law_that_ends_drops_results_by_name_and_time(self):
        self.start({'name': 'shoulder', 'law': 'table', 'times': [0, 0.1, 0.2],
                    'positions': [0, 1, 2]})
        self.publish_states(Polynomials(**COEFFICIENTS))
        values = self.node.wait_for_count('dropped: drive', 40 - LAG - 21)
        self.assertRegex(values['last drop'],
                         "drives: 'shoulder' has no motion at 0.3[34][0-9]* s: it still moves when its "
                         "function ends, at 0.2 s, at stamp ")
        self.assertEqual(len(self.efforts.messages()), 21)

    def test_jumps_and_contradictions_stop_the_start(self):
        for scene, parameters, words in (
                ({'drives': [{'name': 'shoulder', 'law': 'polynomial', 'times': [0, 1.5],
                              'coefficients': [[0], [0, 1]]}]}, {},
                 "drives: 'shoulder': velocity jumps by 1 rad/s or m/s at 1.5 s"),
                ({'drives': [polynomial('shoulder', (0, 1))]}, {'rest': [
                    {'name': 'shoulder', 'position': 1}]},
                 "'shoulder' has a drive, which says how it moves"),
                ({'drives': [polynomial('wrist', (0, 1))]}, {}, "drives[0].name: no ")):
            node = Node(self, ARM, dict({'scene': scene}, **parameters))
            self.assertNotEqual(node.wait(), 0)
            fatal = node.lines('FATAL')
            self.assertEqual(len(fatal), 1, node.output())
            self.assertIn(words, fatal[0])


class DrivenLoops(LoopTest):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.folder)

    def expected(self, ns):
        q, qd, qdd = Polynomials(crank=CRANK)(ns)
        return SliderCrank(q['crank'], qd['crank'], qdd['crank'])

    def test_joint_states_are_a_clock_where_all_follows_from_drives(self):
        scene = driven(dict(SLIDER_CRANK_SCENE, actuated=[]), polynomial('crank_joint', CRANK))
        self.start('effort', scene=scene)
        stamps = [EPOCH + STEP * i for i in range(60)]
        # What they say of the rod is of no use: it follows.
        for ns in stamps:
            self.states.publish(joint_state(ns, {'rod_joint': 1.0}))
        messages = self.recorders['effort'].wait(len(stamps) - LAG - 1)
        for message in messages:
            self.assertMatches(message, self.expected(message.header.stamp.to_nsec()), EXACT)
        self.assertGreater(len(messages), 40)
        values = self.node.diagnostics()
        self.assertEqual(values['passive joints'], 'from the closures')

    def test_what_follows_from_drives_is_never_taken_from_joint_states(self):
        scene = {key: value for key, value in SLIDER_CRANK_SCENE.items() if key != 'actuated'}
        self.start('effort', scene=driven(scene, polynomial('crank_joint', CRANK)))
        stamps = [EPOCH + STEP * i for i in range(60)]
        random = numpy.random.default_rng(7)
        for ns in stamps:
            q = self.expected(ns).q
            self.states.publish(joint_state(
                ns, {name: q[name] + 0.01 * random.standard_normal() for name in JOINTS}))
        messages = self.recorders['effort'].wait(len(stamps) - LAG - 1)
        for message in messages:
            expected = self.expected(message.header.stamp.to_nsec())
            self.assertClose(message.position, [expected.q[name] for name in JOINTS], EXACT, 'q')

    def test_a_ram_that_lifts_a_boom(self):
        scene = driven(LIFT_SCENE, polynomial('ram', (0.8, 0.3, -0.2)))
        self.start('effort', 'reaction/ram', robot=LIFT, scene=scene)
        stamps = [EPOCH + STEP * i for i in range(60)]
        states = [joint_state(ns, {'pin': 0.0}) for ns in stamps]
        for state in states:
            self.states.publish(state)
        messages = self.recorders['effort'].wait(len(stamps) - LAG)
        for message in messages:
            t = (message.header.stamp.to_nsec() - EPOCH) / 1e9
            ram = dict(zip(message.name, zip(message.position, message.velocity)))['ram']
            self.assertClose(ram, [0.8 + 0.3 * t - 0.2 * t * t, 0.3 - 0.4 * t], EXACT, 'length')
        self.offline(LIFT, scene, states, messages)
        # Deviations would have to know the errors of lengths.
        self.assertIn('effort_deviation is not offered', self.node.output())

    def offline(self, robot, scene, states, live):
        """The tool finds the node's efforts in a bag of its joint states."""
        path = {name: os.path.join(self.folder, name) for name in
                ('robot.urdf', 'scene.yaml', 'run.bag', 'results.bag', 'results.csv')}
        with rosbag.Bag(path['run.bag'], 'w') as bag:
            for state in states:
                bag.write('/joint_states', state, state.header.stamp)
        for name, content in (('robot.urdf', robot), ('scene.yaml', yaml.safe_dump(scene))):
            with open(path[name], 'w', encoding='utf-8') as file:
                file.write(content)
        tool = [executable('inverse_dynamics_offline'), '--urdf', path['robot.urdf'], '--scene',
                path['scene.yaml'], '--motion', path['run.bag'], '--output']
        subprocess.run(tool + [path['results.bag']], check=True)
        with rosbag.Bag(path['results.bag']) as bag:
            recorded = [message for topic, message, _ in bag.read_messages()
                        if topic.endswith('effort')]
        self.assertStamps(recorded, [message.header.stamp.to_nsec() for message in live])
        for one, other in zip(recorded, live):
            self.assertEqual((one.name, one.position, one.effort),
                             (other.name, other.position, other.effort))
        # As a table, its rows are all joint states.
        subprocess.run(tool + [path['results.csv']], check=True)
        with open(path['results.csv'], encoding='utf-8') as file:
            lines = file.read().splitlines()
        column = lines[0].split(',').index('effort.ram')
        for line, message in zip(lines[1:], live):
            at = message.header.stamp.to_nsec() - live[0].header.stamp.to_nsec()
            row = lines[1 + (live[0].header.stamp.to_nsec() - EPOCH + at) // STEP].split(',')
            self.assertClose([float(row[column])], [message.effort[message.name.index('ram')]],
                             EXACT, 'effort of the ram')

    def test_tables_and_bags_of_a_bag_have_one_zero_of_time(self):
        scene = {'drives': [polynomial('shoulder', COEFFICIENTS['shoulder'])]}
        path = {name: os.path.join(self.folder, name) for name in
                ('robot.urdf', 'dump.yaml', 'late.yaml', 'run.bag', 'results.bag', 'results.csv', 'late.csv')}
        motion = Polynomials(**COEFFICIENTS)
        with rosbag.Bag(path['run.bag'], 'w') as bag:
            for i in range(-30, 40):
                ns = EPOCH + STEP * i
                q = {'elbow': 1.0} if i < 0 else only(motion(ns)[0], 'elbow', 'slide')
                bag.write('/joint_states', joint_state(ns, q), ros_time(ns))
        for name, content in (('robot.urdf', ARM),
                              ('dump.yaml', yaml.safe_dump({'inverse_dynamics': {'scene': scene}})),
                              ('late.yaml', yaml.safe_dump({'inverse_dynamics': {
                                  'scene': scene, 'drive_start': 1600000000.0}}))):
            with open(path[name], 'w', encoding='utf-8') as file:
                file.write(content)

        def tool(dump, output):
            return subprocess.run(
                [executable('inverse_dynamics_offline'), '--urdf', path['robot.urdf'], '--rosparam',
                 path[dump], '--motion', path['run.bag'], '--positions', '--output', path[output]],
                check=False, stderr=subprocess.PIPE, universal_newlines=True)

        self.assertEqual(tool('dump.yaml', 'results.csv').returncode, 0)
        with open(path['results.csv'], encoding='utf-8') as file:
            header, first = [line.split(',') for line in file.read().splitlines()[:2]]
        self.assertEqual(float(first[header.index('position.shoulder')]), 0.3)
        self.assertEqual(tool('late.yaml', 'late.csv').returncode, 0)
        with open(path['late.csv'], encoding='utf-8') as file:
            lines = [line.split(',') for line in file.read().splitlines()]
        # A bag of results has a lag less of them.
        for dump, table in (('dump.yaml', 'results.csv'), ('late.yaml', 'late.csv')):
            with open(path[table], encoding='utf-8') as file:
                header, *rows = [line.split(',') for line in file.read().splitlines()]
            efforts = self.efforts_of(path, dump)
            self.assertEqual(efforts[0].header.stamp, ros_time(EPOCH))
            for effort, row in zip(efforts, rows):
                self.assertEqual(by_name(effort, effort.position)['shoulder'],
                                 float(row[header.index('position.shoulder')]))
        t = (EPOCH - 1600000000 * 1000000000) / 1e9
        a, b, c = COEFFICIENTS['shoulder']
        self.assertGreater(t, 0)
        self.assertClose([float(lines[1][lines[0].index('position.shoulder')])],
                         [a + b * t + c * t * t], 1e-12, 'the law at its stamp')
        self.assertEqual(float(lines[1][lines[0].index('time')]), 0)
        with open(path['late.yaml'], 'w', encoding='utf-8') as file:
            yaml.safe_dump({'inverse_dynamics': {'scene': scene, 'drive_start': 'soon'}}, file)
        refused = tool('late.yaml', 'late.csv')
        self.assertNotEqual(refused.returncode, 0)
        self.assertIn('drive_start: is not a stamp in s', refused.stderr)

    def efforts_of(self, path, dump):
        subprocess.run([executable('inverse_dynamics_offline'), '--urdf', path['robot.urdf'],
                        '--rosparam', path[dump], '--motion', path['run.bag'], '--output',
                        path['results.bag']], check=True)
        with rosbag.Bag(path['results.bag']) as bag:
            return [message for topic, message, _ in bag.read_messages()
                    if topic.endswith('effort')]


if __name__ == '__main__':
    run(DrivenJoints, DrivenLoops)
