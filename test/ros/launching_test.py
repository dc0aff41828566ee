#!/usr/bin/python3
"""The launch files, as a user starts them: from any folder, with odd paths, in namespaces."""
import glob
import json
import os
import re
import shutil
import stat
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree
import xml.sax.saxutils

from geometry_msgs.msg import WrenchStamped
import rosbag
import rosgraph
import rospkg
import rospy
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from node_under_test import (PACKAGE, NodeTest, Process, Recorder, executable, read, run, wait_until)

ARM = read('data', 'arm.urdf')
ROOT, TOOL = 'stand', 'tool'
G = 9.81
# Exact but for the rounding of a sum of a few products.
ROUNDING = 1e-12
# What a clean shell has.
CLEAN = {'HOME': os.path.expanduser('~'), 'PATH': '/usr/bin:/bin'}
PACKAGE_OF_RVIZ = 'rviz'
ODD = 'a user\'s "odd" (folder)'
# What `roslaunch --args` prints, as a list.
COMMAND = """
import json, sys
from roslaunch.node_args import get_node_args
from roslaunch.rlutil import resolve_launch_arguments
node = sys.argv.pop(1)
print(json.dumps(get_node_args(node, resolve_launch_arguments(sys.argv[1:])[:1])))
"""
MOTION = """joints: []
law: table
file: the table's "t".csv
rate: 100
velocities: false
loop: true
"""


def launch_folder():
    return os.path.join(rospkg.RosPack().get_path(PACKAGE), 'launch')


def nodes():
    """Names of all nodes that publish something."""
    publishers = rosgraph.Master('/test').getSystemState()[0]
    return {node for _, names in publishers for node in names}


def clean_environment():
    """What is left of the environment in a clean shell with the workspace's set-up."""
    workspace = os.environ.get('CMAKE_PREFIX_PATH', '').split(':')[0]
    setup = os.path.join(workspace, 'setup.bash')
    source = 'source "$0"; env -0' if os.path.exists(setup) else 'env -0'
    text = subprocess.run(['bash', '-c', source, setup], env=CLEAN, check=True,
                          stdout=subprocess.PIPE).stdout.decode()
    environment = dict(entry.split('=', 1) for entry in text.split('\0') if '=' in entry)
    for name in ('ROS_MASTER_URI', 'ROS_HOSTNAME', 'ROS_IP'):
        if name in os.environ:
            environment[name] = os.environ[name]
    # As a program leaves it that starts another one in another folder.
    environment['PWD'] = '/'
    return environment


class Launching(NodeTest):
    def setUp(self):
        self.top = tempfile.mkdtemp(prefix='vwd_test_')
        self.addCleanup(shutil.rmtree, self.top)
        self.folder = os.path.join(self.top, ODD)
        os.mkdir(self.folder)
        # Of tests before this one, which every namespace would find.
        if rospy.has_param('/robot_description'):
            rospy.delete_param('/robot_description')
        self.environment = dict(clean_environment(), ROS_HOME=os.path.join(self.top, 'ros_home'))

    def write(self, name, text, mode=None):
        """A file in the folder; returns its name."""
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
        if mode:
            os.chmod(path, mode)
        return name

    def program(self, name, text):
        return self.write(name, '#!/bin/sh\n' + text, stat.S_IRWXU)

    def package(self, name, program, text):
        """A ROS package with a program, in the folder `packages`."""
        self.write('packages/%s/package.xml' % name,
                   '<package><name>%s</name><version>1.0.0</version><description>x</description>'
                   '<maintainer email="a@b.c">a</maintainer><license>BSD</license></package>' % name)
        self.program('packages/%s/%s' % (name, program), text)
        packages = os.path.join(self.folder, 'packages')
        self.environment['ROS_PACKAGE_PATH'] = packages + ':' + self.environment['ROS_PACKAGE_PATH']

    def launch(self, *arguments, namespace=None):
        """roslaunch in the folder; `arguments` begin with the package or a file."""
        more = {'ROS_NAMESPACE': namespace} if namespace else {}
        process = Process(self, [shutil.which('roslaunch'), *arguments], more, self.environment,
                          self.folder)

        def end():
            # Not killed, as its nodes would go on.
            if not process.ended():
                process.interrupt()
                process.wait()
        self.addCleanup(end)
        process.end = end
        return process

    def inverse_dynamics(self, *arguments, namespace=None):
        return self.launch(PACKAGE, 'inverse_dynamics.launch', *arguments, namespace=namespace)

    def command(self, node, *arguments):
        """How roslaunch would start a node: its namespace, and the words of the command line."""
        result = subprocess.run(['/usr/bin/python3', '-c', COMMAND, node, *arguments], check=True,
                                env=self.environment, cwd=self.folder, stdout=subprocess.PIPE)
        words = json.loads(result.stdout.decode())
        return [word for word in words if word.startswith('ROS_NAMESPACE=')], \
            words[words.index('sh'):]

    def record(self, topic, kind):
        recorder = Recorder(topic, kind)
        self.addCleanup(recorder.stop)
        return recorder

    def first(self, launch, recorder):
        """The first message, unless roslaunch ends before it."""
        wait_until(lambda: recorder.raw or launch.ended(),
                   lambda: recorder.topic + '; roslaunch says ' + launch.output())
        self.assertTrue(recorder.raw, launch.output())
        return recorder.messages()[0]

    def recorded(self, launch, *recorders):
        """Waits until what these recorders have is also in bags of the launch."""
        for recorder in recorders:
            wait_until(lambda: 'Subscribing to %s\n' % recorder.topic in launch.output(),
                       launch.output)
            recorder.wait(len(recorder.raw) + 20)

    def motion(self):
        """A motion of the arm, which rests at zero; returns the name of its file."""
        self.write('the table\'s "t".csv', 'time,position.shoulder,position.elbow,position.slide\n' +
                   ''.join('%r,0,0,0\n' % (0.05 * row) for row in range(20)))
        return self.write('the motion\'s "m".yaml', MOTION)

    def topics(self, bag):
        with rosbag.Bag(os.path.join(self.folder, bag)) as content:
            return set(content.get_type_and_topic_info().topics)

    # --- paths

    def test_every_path_is_relative_to_where_roslaunch_is_started(self):
        scene = 'gravity: [0, 0, -%r]\nmotion: static\nreactions: [elbow]\n' % (2 * G)
        wrenches = self.record('/inverse_dynamics/reaction/elbow', WrenchStamped)
        launch = self.inverse_dynamics(
            'robot:=' + self.write('the robot\'s "r".urdf', ARM),
            'scene:=' + self.write('the scene\'s "s".yaml', scene),
            'parameters:=' + self.write('the parameters\' "p".yaml', 'late_threshold: 0.5\n'),
            'trajectory:=' + self.motion(), 'bag:=the bag\'s "b".bag')
        self.first(launch, wrenches)
        self.assertEqual(rospy.get_param('/inverse_dynamics/late_threshold'), 0.5)
        self.assertEqual(rospy.get_param('/inverse_dynamics/scene/gravity'), [0, 0, -2 * G])
        self.assertEqual(rospy.get_param('/robot_description'), ARM)
        self.recorded(launch, wrenches)
        launch.end()
        recorded = self.topics('the bag\'s "b".bag')
        self.assertLessEqual({'/joint_states', '/inverse_dynamics/effort', '/tf', '/diagnostics',
                              '/inverse_dynamics/reaction/elbow'}, recorded)

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
        launch = self.inverse_dynamics('robot:=the robot\'s "r".urdf', namespace='nothing')
        self.assertEqual(launch.wait(), 1)
        self.assertIn('\nrobot:=the robot\'s "r".urdf: No such file or directory\n',
                      '\n' + launch.output())

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

    # --- xacro

    def read_robot(self, path, **environment):
        return subprocess.run([executable('read_robot.py'), path], cwd=self.folder, check=False,
                              env=dict(self.environment, **environment), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, encoding='utf-8')

    def test_xacro_in_path(self):
        self.program('bin/xacro', 'echo "xacro: a warning" >&2; sed s/ARM/test_arm/ "$1"\n')
        self.environment['PATH'] += ':' + os.path.join(self.folder, 'bin')
        name = self.write('the robot\'s "r".urdf.xacro', ARM.replace('name="test_arm"', 'name="ARM"'))
        result = self.read_robot(name)
        self.assertEqual((result.returncode, result.stdout, result.stderr),
                         (0, ARM, 'xacro: a warning\n'))
        launch = self.inverse_dynamics('robot:=' + name, namespace='expanded')
        wait_until(lambda: "Robot 'test_arm' from /expanded/robot_description" in launch.output(),
                   launch.output)
        # A name that begins with a dash is not taken for an option.
        self.assertEqual(self.read_robot(self.write('-v.xacro', ARM)).stdout, ARM)

    def test_xacro_as_a_package(self):
        if shutil.which('xacro'):
            self.skipTest('xacro is installed')
        self.package('xacro', 'xacro', 'cat "$1"\n')
        result = self.read_robot(self.write('robot.xacro', ARM))
        self.assertEqual((result.returncode, result.stdout), (0, ARM), result.stderr)

    def test_without_xacro_one_line_says_how(self):
        empty = os.path.join(self.folder, 'empty')
        result = self.read_robot(self.write('the robot\'s "r".urdf.xacro', ARM), PATH=empty)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
        for part in ('robot:=the robot\'s "r".urdf.xacro: needs xacro, which is not installed',
                     'sudo apt install ros-noetic-xacro',
                     'xacro \'the robot\'"\'"\'s "r".urdf.xacro\' > robot.urdf'):
            self.assertIn(part, result.stderr)

    def test_what_xacro_says_is_one_line(self):
        self.program('bin/xacro', 'printf "undefined name\\n\\n  in file\\n" >&2; exit 2\n')
        self.environment['PATH'] += ':' + os.path.join(self.folder, 'bin')
        result = self.read_robot(self.write('robot.xacro', ARM))
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr,
                         'robot:=robot.xacro: xacro cannot expand it: undefined name; in file\n')

    def test_files_that_are_no_description(self):
        with open(os.path.join(self.folder, 'latin.urdf'), 'wb') as file:
            file.write('<robot name="B\xe4r"/>'.encode('latin-1'))
        for path, problem in (('latin.urdf', 'is not text in UTF-8'),
                              ('/dev/zero', 'is longer than any description of a robot'),
                              ('.', 'Is a directory'), ('no.xacro', 'No such file or directory')):
            result = self.read_robot(path)
            self.assertEqual((result.returncode, result.stderr),
                             (1, 'robot:=%s: %s\n' % (path, problem)))

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
        self.recorded(launch, *efforts, *tools)
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

    def test_all_examples_in_namespaces(self):
        examples = sorted(name[:-len('.launch')] for name in os.listdir(launch_folder())
                          if name not in ('inverse_dynamics.launch', 'demo.launch',
                                          'closed_loop_example.launch'))
        text = ''.join(
            '<group ns="{0}"><include file="$(find {1})/launch/{0}.launch">'
            '<arg name="frame_prefix" value="{0}"/><arg name="bag" value="{0}\'s bag.bag"/>'
            '</include></group>'.format(example, PACKAGE) for example in examples)
        text += ('<group ns="by_name"><include file="$(find %s)/launch/closed_loop_example.launch">'
                 '<arg name="example" value="four_bar"/></include></group>' % PACKAGE)
        efforts = {example: self.record('/%s/inverse_dynamics/effort' % example, JointState)
                   for example in examples + ['by_name']}
        launch = self.launch(self.write('all.launch', '<launch>%s</launch>' % text))
        for example, effort in efforts.items():
            frame = self.first(launch, effort).header.frame_id
            self.assertEqual(frame.startswith(example + '/'), example != 'by_name', frame)
        for example in examples:
            efforts[example].wait(20)
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
