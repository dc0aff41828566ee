#!/usr/bin/python3
"""What is looked at: RViz's start, tf with rviz:=true, motions that are shown, layouts for plots. A program of
the test's own stands in for RViz."""
import json
import os
import signal
import subprocess
import xml.etree.ElementTree as ElementTree

from geometry_msgs.msg import WrenchStamped
import rosgraph
import roslib.message
import rospy
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import yaml

from node_under_test import HERE, Node, PACKAGE, Process, Recorder, executable, read, run, wait_until
from rviz_configuration import ROBOT, SIX_AXIS_ARM, RvizTest, displays_of

ROOT = os.path.dirname(os.path.dirname(HERE))
ARM = read('data', 'arm.urdf')
# Keeps what it is given for its namespace, and then does as RViz does: it runs until it is ended.
STAND_IN = '''#!/bin/sh
mkdir -p "$RVIZ_SEEN$ROS_NAMESPACE"
cat "$2" > "$RVIZ_SEEN$ROS_NAMESPACE/config" && printf '%s\\n' "$@" > "$RVIZ_SEEN$ROS_NAMESPACE/words"
exec sleep 600
'''


class Launch(Process):
    """roslaunch, which ends its nodes when it is interrupted."""

    def _kill(self):
        if not self.ended():
            self.interrupt()
            self.wait()
        super()._kill()


class Looking(RvizTest):
    def setUp(self):
        super().setUp()
        self.seen = os.path.join(self.folder, 'seen')
        self.temporary = os.path.join(self.folder, 'tmp')
        for name in ('seen', 'tmp', 'bin'):
            os.mkdir(os.path.join(self.folder, name))
        rviz = self.write('bin/rviz', STAND_IN)
        os.chmod(rviz, 0o755)
        self.environment = {'RVIZ_SEEN': self.seen, 'TMPDIR': self.temporary,
                            'PATH': os.path.dirname(rviz) + ':' + os.environ['PATH']}

    def test_two_robots_in_two_namespaces(self):
        master = rosgraph.Master('/test')
        for side, robot, scene in (('left', ARM, {'reactions': ['elbow', 'ground']}),
                                   ('right', ROBOT, {'reactions': 'all'})):
            node = Node(self, robot, {'scene': scene, 'frame_prefix': side + '/'})
            node.diagnostics()  # and so all its topics are there
            config = self.config('__ns:=' + node.namespace)
            self.assertEqual(config, self.config(ROS_NAMESPACE=node.namespace))
            arrows = displays_of(config, 'rviz/WrenchStamped')
            self.assertEqual([display['Name'] for display in arrows],
                             ['ground', 'elbow'] if side == 'left' else ['pin'])
            topics = [display['Topic'] for display in arrows]
            topics.append(displays_of(config, 'rviz/MarkerArray')[0]['Marker Topic'])
            published = [topic for topic, nodes in master.getSystemState()[0] if node.name in nodes]
            self.assertTrue(set(topics) <= set(published), topics)
            model, = displays_of(config, 'rviz/RobotModel')
            self.assertEqual(rospy.get_param(model['Robot Description']), robot)
            self.assertEqual(model['TF Prefix'], side)
            self.assertEqual(config['Global Options']['Fixed Frame'],
                             side + ('/stand' if side == 'left' else '/base'))

    def test_rviz_gets_its_words_and_nothing_is_left_behind(self):
        robot = self.write('robot.urdf', ROBOT)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
            with self.subTest(signal=number):
                process = subprocess.Popen(
                    [executable('rviz_for_robot'), '--frame=map', robot, '--fullscreen', '__name:=eye'],
                    env=dict(os.environ, ROS_NAMESPACE='/side', **self.environment))
                self.addCleanup(process.kill)
                words = os.path.join(self.seen, 'side', 'words')
                wait_until(lambda: os.path.exists(words) and open(words).read().count('\n') == 4,
                           'RViz')
                with open(words) as file:
                    self.assertEqual([file.readline() == '-d\n', file.readline() != '',
                                      file.read()], [True, True, '--fullscreen\n__name:=eye\n'])
                with open(os.path.join(self.seen, 'side', 'config')) as file:
                    config = yaml.safe_load(file)['Visualization Manager']
                self.assertEqual(config['Global Options']['Fixed Frame'], 'map')
                process.send_signal(number)
                self.assertEqual(process.wait(), -number)
                self.assertEqual(os.listdir(self.temporary), [])
                os.remove(words)

    def test_robot_and_arrows_are_of_the_same_instant(self):
        """Two arms at once, each in a namespace, as roslaunch starts them with rviz:=true."""
        frames = Recorder('/tf', TFMessage)
        self.addCleanup(frames.stop)
        for side in ('/left', '/right'):
            Launch(self, ['roslaunch', '--disable-title', PACKAGE, 'six_axis_arm.launch', 'rviz:=true'],
                   dict(self.environment, ROS_NAMESPACE=side))
        effort = Recorder('/left/inverse_dynamics/effort', JointState)
        self.addCleanup(effort.stop)
        wrench = Recorder('/left/inverse_dynamics/reaction/joint_6', WrenchStamped)
        self.addCleanup(wrench.stop)
        for side in ('left', 'right'):
            path = os.path.join(self.seen, side, 'words')
            wait_until(lambda: os.path.exists(path), 'RViz of ' + side)
            with open(os.path.join(self.seen, side, 'config')) as file:
                config = yaml.safe_load(file)['Visualization Manager']
            self.assertEqual([d['Topic'] for d in displays_of(config, 'rviz/WrenchStamped')],
                             ['/%s/inverse_dynamics/reaction/%s' % (side, joint)
                              for joint in SIX_AXIS_ARM])
            self.assertEqual(displays_of(config, 'rviz/RobotModel')[0]['Robot Description'],
                             '/%s/robot_description' % side)
        wait_until(lambda: '/left/robot_state_publisher' in dict(
            rosgraph.Master('/test').getSystemState()[1]).get('/left/inverse_dynamics/effort', []),
                   'robot_state_publisher to listen to efforts')

        def shown():
            """Instants of frames of this arm, those of the other one are of its own, and of arrows."""
            stamps = {message.header.stamp.to_nsec() for message in wrench.messages()}
            theirs = {m.header.stamp.to_nsec() for m in effort.messages()}
            moved = {t.header.stamp.to_nsec() for m in frames.messages() for t in m.transforms}
            return stamps, {stamp for stamp in moved & theirs
                            if min(stamps) <= stamp <= max(stamps)}
        wrench.wait(500)
        wait_until(lambda: len(shown()[1]) > 100, 'frames of the arm')
        stamps, instants = shown()
        self.assertLessEqual(instants, stamps)

    def test_a_fast_turn_is_played_slowly_before_the_next_begins(self):
        motion = yaml.safe_load(read('..', '..', 'config', 'andrews_squeezer_trajectory.yaml'))
        launch = ElementTree.fromstring(read('..', '..', 'launch', 'andrews_squeezer.launch'))
        rate, = [float(argument.get('value')) for argument in launch.iter('arg')
                 if argument.get('name') == 'trajectory_rate']
        duration = motion['via_points'][-1]['time']
        played = (duration * motion['rate'] + 1) / rate
        self.assertTrue(motion['loop'])
        self.assertGreater(played, 3)
        self.assertLess(played, duration + motion['loop_pause'])

    def test_the_legs_of_the_platform_stay_together(self):
        motion = yaml.safe_load(read('..', '..', 'config', 'stewart_gough_trajectory.yaml'))
        robot = ElementTree.fromstring(read('..', '..', 'urdf', 'stewart_gough.urdf'))

        def drawn(link):
            """From where to where along the leg its cylinder goes."""
            visual = robot.find("link[@name='%s']/visual" % link)
            middle = float(visual.find('origin').get('xyz').split()[2])
            half = float(visual.find('geometry/cylinder').get('length')) / 2
            return middle - half, middle + half

        between = 0.02  # how far a minimum-jerk motion goes beyond its points
        for leg, name in enumerate(motion['joints']):
            lengths = [point['positions'][leg] for point in motion['via_points']]
            carrier = robot.find("joint[@name='%s']" % name)
            tube, rod = (drawn(carrier.find(side).get('link')) for side in ('parent', 'child'))
            self.assertEqual(tube[0], 0)
            self.assertEqual(rod[1], 0)
            self.assertGreater(tube[1], max(lengths) * (1 + between) + rod[0])
            self.assertGreater(min(lengths) * (1 - between) + rod[0], 0)

    def test_layouts_name_what_is_published(self):
        node = Node(self, read('..', '..', 'urdf', 'six_axis_arm.urdf'))
        master = rosgraph.Master('/test')
        node.diagnostics()  # and so all its topics are there
        types = dict(master.getTopicTypes())
        joints = SIX_AXIS_ARM

        def check(series, by_joint):
            self.assertTrue(series.startswith('/inverse_dynamics/'), series)
            series = series.replace('/inverse_dynamics', node.name, 1)
            topic = max((topic for topic in types if series.startswith(topic + '/')), key=len)
            message = roslib.message.get_message_class(types[topic])()
            fields = series[len(topic) + 1:].split('/')
            if by_joint and types[topic] == 'sensor_msgs/JointState':
                self.assertIn(fields.pop(0), joints)
            for field in fields:
                name, _, place = field.partition('[')
                message = getattr(message, name)
                if place:
                    self.assertLess(int(place.rstrip(']')), len(joints))

        folder = os.path.join(ROOT, 'config')
        layout = ElementTree.parse(folder + '/six_axis_arm_plotjuggler.xml').getroot()
        curves = [curve.get('name') for curve in layout.iter('curve')]
        self.assertGreaterEqual(len(curves), 12)
        for curve in curves:
            check(curve, True)
        subscribed = layout.find('.//selected_topics').get('value').split(';')
        for topic in subscribed:
            self.assertIn(topic.replace('/inverse_dynamics', node.name, 1), types)
        for curve in curves:
            self.assertTrue(any(curve.startswith(topic + '/') for topic in subscribed), curve)
        with open(folder + '/six_axis_arm_rqt_plot.perspective') as file:
            plugins = json.load(file)['groups']['pluginmanager']['groups']
        self.assertEqual(len(plugins), 3)
        for plugin in plugins.values():
            for topic in yaml.safe_load(plugin['groups']['plugin']['keys']['topics']['repr']):
                check(topic, False)


if __name__ == '__main__':
    run(Looking)
