#!/usr/bin/python3
"""The launch files: paths, robots that are there already, namespaces, arguments."""
import glob
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
import xml.sax.saxutils

from geometry_msgs.msg import WrenchStamped
import rosgraph
import rospkg
import rospy
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from launches import ARM, LaunchTest
from node_under_test import PACKAGE, run, wait_until

ROOT = 'stand'
G = 9.81
PACKAGE_OF_RVIZ = 'rviz'


def launch_folder():
    return os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch')


def nodes():
    """Names of all nodes that publish something."""
    publishers = rosgraph.Master('/test').getSystemState()[0]
    return {node for _, names in publishers for node in names}


class Launching(LaunchTest):
    # --- paths

    def test_every_path_is_relative_to_where_roslaunch_is_started(self):
        scene = 'gravity: [0, 0, -%r]\nmotion: static\nreactions: [elbow]\n' % (2 * G)
        wrenches = self.record('/inverse_dynamics/reaction/elbow', WrenchStamped)
        others = [self.record('/inverse_dynamics/effort', JointState),
                  self.record('/joint_states', JointState), self.record('/tf', TFMessage)]
        launch = self.inverse_dynamics(
            'robot:=' + self.write('the robot\'s "r".urdf', ARM),
            'scene:=' + self.write('the scene\'s "s".yaml', scene),
            'parameters:=' + self.write('the parameters\' "p".yaml', 'late_threshold: 0.5\n'),
            'trajectory:=' + self.motion(), 'bag:=the bag\'s "b".bag')
        self.first(launch, wrenches)
        self.assertEqual(rospy.get_param('/inverse_dynamics/late_threshold'), 0.5)
        self.assertEqual(rospy.get_param('/inverse_dynamics/scene/gravity'), [0, 0, -2 * G])
        self.assertEqual(rospy.get_param('/robot_description'), ARM)
        self.recorded(launch, wrenches, *others)
        launch.end()
        self.assertLessEqual({recorder.topic for recorder in [wrenches, *others]},
                             self.topics('the bag\'s "b".bag'))

    def test_rviz_starts_where_roslaunch_is_started(self):
        if PACKAGE_OF_RVIZ not in rospkg.RosPack().list():
            self.package(PACKAGE_OF_RVIZ, 'rviz', '')
        arguments = [PACKAGE, 'inverse_dynamics.launch', 'robot:=' + self.write('robot.urdf', ARM),
                     'bag:=b.bag', 'rviz:=true', 'rviz_config:=the picture\'s "p".rviz']
        recorder = self.command('/recorder', *arguments)[1]
        rviz = self.command('/rviz', *arguments, 'rviz_frame:=tool')[1]
        self.assertEqual(rviz[4:8], ['-d', 'the picture\'s "p".rviz', '-f', 'tool'])
        # As the recorder, whose bags show that it does what it is for.
        self.assertEqual(rviz[:3], ['sh', '-c', 'cd -P /proc/$PPID/cwd && exec "$0" "$@"'])
        self.assertEqual(recorder[2][:len(rviz[2])], rviz[2])

    def test_names_that_look_like_numbers(self):
        efforts = self.record('/numbers/inverse_dynamics/effort', JointState)
        launch = self.inverse_dynamics(
            'robot:=' + self.write('007', ARM), 'scene:=' + self.write('1.50', 'motion: static\n'),
            'trajectory:=' + self.motion(), 'bag:=0x10', namespace='numbers')
        self.first(launch, efforts)
        self.recorded(launch, efforts)
        launch.end()
        self.assertIn('/numbers/inverse_dynamics/effort', self.topics('0x10.bag'))

    def test_files_that_are_not_there(self):
        self.write('robot.urdf', ARM)
        for argument, others in (('robot:=the robot\'s "r".urdf', ()),
                                 ('scene:=the scene\'s "s".yaml', ('robot:=robot.urdf',))):
            launch = self.inverse_dynamics(argument, *others, namespace='nothing')
            self.assertEqual(launch.wait(), 1)
            self.assertIn('\n%s: No such file or directory\n' % argument, '\n' + launch.output())

    # --- a robot that is there

    def test_without_a_robot_the_description_that_is_there_is_used(self):
        rospy.set_param('/there/robot_description', ARM)
        # What a launch before this one has left.
        rospy.set_param('/there/inverse_dynamics/scene', {'gravity': [0, 0, 1]})
        efforts = self.record('/there/inverse_dynamics/effort', JointState)
        launch = self.inverse_dynamics('trajectory:=' + self.motion(), namespace='there')
        self.first(launch, efforts)
        self.assertIn("Robot 'test_arm' from /there/robot_description", launch.output())
        self.assertIn('gravity [0, 0, -9.81] m/s^2', launch.output())
        self.assertEqual(rospy.get_param('/there/robot_description'), ARM)
        self.assertEqual({node for node in nodes() if node.startswith('/there/')},
                         {'/there/inverse_dynamics', '/there/trajectory_publisher'})

    def test_without_any_description_the_node_says_so(self):
        launch = self.inverse_dynamics(namespace='/empty')
        launch.wait()
        self.assertEqual(launch.lines('FATAL'), [
            'parameter robot_description: not set, neither in /empty/inverse_dynamics nor in any '
            'namespace above it; robot:=FILE of inverse_dynamics.launch sets it'])

    # --- namespaces and prefixes

    def test_two_robots_in_two_namespaces(self):
        if PACKAGE_OF_RVIZ not in rospkg.RosPack().list():
            self.package(PACKAGE_OF_RVIZ, 'rviz', '')
        robot = self.write('robot.urdf', ARM)
        motion = self.motion()
        group = ''.join(
            '<group ns="{0}"><include file="$(find {1})/launch/inverse_dynamics.launch">'
            '<arg name="robot" value="{2}"/><arg name="trajectory" value={3}/>'
            '<arg name="frame_prefix" value="{4}"/><arg name="bag" value="{0}.bag"/>'
            '<arg name="rviz" value="$(arg rviz)"/><arg name="rviz_config" value="my {0}.rviz"/>'
            '</include></group>'.format(side, PACKAGE, robot, xml.sax.saxutils.quoteattr(motion),
                                        prefix)
            for side, prefix in (('left', 'left'), ('right', '/far/right/')))
        self.write('two robots.launch', '<launch><arg name="rviz" default="false"/>%s</launch>' % group)
        sides = (('left', 'left/'), ('right', 'far/right/'))
        efforts = [self.record('/%s/inverse_dynamics/effort' % side, JointState)
                   for side, _ in sides]
        tools = [self.record('/%s/inverse_dynamics/reaction/elbow' % side, WrenchStamped)
                 for side, _ in sides]
        states = [self.record('/%s/joint_states' % side, JointState) for side, _ in sides]
        moving, fixed = self.record('/tf', TFMessage), self.record('/tf_static', TFMessage)
        launch = self.launch('two robots.launch')
        links = {link.get('name') for link in ElementTree.fromstring(ARM).findall('link')}
        for (_, prefix), effort, tool in zip(sides, efforts, tools):
            self.assertEqual(self.first(launch, effort).header.frame_id, prefix + ROOT)
            self.assertIn(self.first(launch, tool).header.frame_id, {prefix + n for n in links})

        def frames():
            return {name for message in moving.messages() + fixed.messages()
                    for transform in message.transforms
                    for name in (transform.header.frame_id, transform.child_frame_id)}
        wanted = {prefix + link for _, prefix in sides for link in links}
        wait_until(lambda: wanted <= frames(), lambda: '%s, got %s' % (wanted, frames()))
        self.assertEqual(frames(), wanted)
        for side, _ in sides:
            namespace, words = self.command('/%s/rviz' % side, 'two robots.launch', 'rviz:=true')
            self.assertEqual((namespace, words[4:6]),
                             (['ROS_NAMESPACE="/%s"' % side], ['-d', 'my %s.rviz' % side]))
        self.recorded(launch, *efforts, *tools, *states, moving)
        launch.end()
        for side, _ in sides:
            recorded = self.topics(side + '.bag')
            self.assertLessEqual({'/%s/joint_states' % side, '/tf',
                                  '/%s/inverse_dynamics/effort' % side}, recorded)
            self.assertEqual({topic for topic in recorded if topic.count('/') > 1 and
                              not topic.startswith('/%s/' % side)}, set())

    # --- all launch files

    def test_all_arguments_are_documented(self):
        for path in glob.glob(os.path.join(launch_folder(), '*.launch')):
            result = subprocess.run([shutil.which('roslaunch'), '--ros-args', path], check=False,
                                    env=self.environment, cwd=self.folder, stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, encoding='utf-8')
            self.assertEqual(result.returncode, 0, result.stdout)
            listed, required = {}, None
            for line in result.stdout.splitlines():
                if line.startswith('  '):
                    name, doc = re.match('  (\\w+)(?: \\(default ".*"\\))?: (.*)', line).groups()
                    listed[name] = (doc, required)
                else:
                    required = line.startswith('Required')
            arguments = [arg for arg in ElementTree.parse(path).getroot().findall('arg')
                         if arg.get('value') is None]
            self.assertEqual(listed, {arg.get('name'): (arg.get('doc'), arg.get('default') is None)
                                      for arg in arguments}, result.stdout)
            for arg in arguments:
                self.assertTrue(arg.get('doc'), arg.get('name'))

    # Some at a time: forty processes at once are busy with each other.
    def test_all_examples_in_namespaces(self):
        examples = sorted(name[:-len('.launch')] for name in os.listdir(launch_folder())
                          if name not in ('inverse_dynamics.launch', 'demo.launch',
                                          'closed_loop_example.launch'))
        for i in range(0, len(examples), 3):
            self.launch_in_namespaces(examples[i:i + 3])

    def launch_in_namespaces(self, examples):
        text = ''.join(
            '<group ns="{0}"><include file="$(find {1})/launch/{0}.launch">'
            '<arg name="frame_prefix" value="{0}"/><arg name="bag" value="{0}\'s bag.bag"/>'
            '</include></group>'.format(example, PACKAGE) for example in examples)
        text += ('<group ns="by_name"><include file="$(find %s)/launch/closed_loop_example.launch">'
                 '<arg name="example" value="four_bar"/></include></group>' % PACKAGE)
        efforts = {example: self.record('/%s/inverse_dynamics/effort' % example, JointState)
                   for example in examples + ['by_name']}
        launch = self.launch(self.write('some.launch', '<launch>%s</launch>' % text))
        for example, effort in efforts.items():
            frame = self.first(launch, effort).header.frame_id
            self.assertEqual(frame.startswith(example + '/'), example != 'by_name', frame)
        self.recorded(launch, *(efforts[example] for example in examples))
        launch.end()
        for example in examples:
            self.assertIn('/%s/inverse_dynamics/effort' % example,
                          self.topics(example + "'s bag.bag"))

    def test_demo(self):
        launch = self.launch(PACKAGE, 'demo.launch', "bag:=the demo's bag.bag")
        path = os.path.join(self.folder, "the demo's bag.bag.active")
        wait_until(lambda: os.path.exists(path) or launch.ended(), launch.output)
        self.assertTrue(os.path.exists(path), launch.output())


if __name__ == '__main__':
    run(Launching)
