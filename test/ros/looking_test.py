#!/usr/bin/python3
"""What is looked at: the configuration that rviz_for_robot writes, RViz's start, tf with rviz:=true,
layouts for plots. A program of the test's own stands in for RViz."""
import json
import os
import signal
import subprocess
import tempfile
import xml.etree.ElementTree as ElementTree

from geometry_msgs.msg import WrenchStamped
import rosgraph
import roslib.message
import rospy
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import yaml

from node_under_test import (HERE, Node, NodeTest, PACKAGE, Process, Recorder, executable, read, run,
                             wait_until)

ROOT = os.path.dirname(os.path.dirname(HERE))
ARM = read('data', 'arm.urdf')
LINK = ('<link name="%s"><inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.01" ixy="0" '
        'ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>')
JOINT = ('<joint name="%s" type="continuous"><parent link="%s"/><child link="%s"/>'
         '<origin xyz="0.1 0 0"/><axis xyz="0 1 0"/></joint>')
ONE_JOINT = '<link name="base"/>' + LINK % 'arm' + JOINT % ('pin', 'base', 'arm')
ROBOT = '<robot name="r">' + ONE_JOINT + '</robot>'
EXAMPLES = {
    'composed_pendulum': ['joint_1', 'joint_2'],
    'six_axis_arm': ['joint_%d' % i for i in range(1, 7)],
    'four_bar': ['crank_joint', 'coupler_joint', 'rocker_joint', 'rocker_pin'],
    'slider_crank': ['crank_joint', 'rod_joint', 'slider_joint', 'wrist_pin'],
    'andrews_squeezer': ['beta', 'theta', 'delta', 'phi', 'epsilon', 'omega', 'gamma', 'E_BDE', 'E_EG',
                         'E_HE'],
    'planar_3rrr': None,
    'stewart_gough': None,
    'spatial_parallelogram': None,
    'excavator': ['boom_joint', 'stick_joint', 'bucket_joint', 'boom_ram', 'stick_ram', 'bucket_ram'],
    'coupled_wrist': None,
    'planetary_gear': None,
    'mobile_manipulator': ['base_x', 'base_y', 'base_yaw', 'left_wheel', 'pan', 'shoulder', 'elbow',
                           'right_wheel', 'left_tread', 'right_tread'],
    'rolling_disc': ['disc_x', 'disc_y', 'disc_z', 'heading', 'lean', 'spin', 'rim'],
    'biped': ['pelvis_x', 'pelvis_y', 'pelvis_z', 'pelvis_yaw', 'pelvis_roll', 'left_hip', 'right_hip',
              'waist', 'left_sole', 'right_sole'],
    'arm_on_a_ship': ['ground'] + ['joint_%d' % i for i in range(1, 7)],
    'balance_board': ['ground', 'ankle', 'knee', 'hip', 'waist'],
    'quadruped': ['ground'],
}
# Of examples that do not have a description of their own.
ROBOTS = {'arm_on_a_ship': 'six_axis_arm'}
# Keeps what it is given for its namespace, and then does as RViz does: it runs until it is ended.
STAND_IN = '''#!/bin/sh
mkdir -p "$RVIZ_SEEN$ROS_NAMESPACE"
cat "$2" > "$RVIZ_SEEN$ROS_NAMESPACE/config" && printf '%s\\n' "$@" > "$RVIZ_SEEN$ROS_NAMESPACE/words"
exec sleep 600
'''


def displays_of(config, kind):
    """All displays of a class, those in groups included."""
    found = []
    for display in config['Displays']:
        if display['Class'] == kind:
            found.append(display)
        if display['Class'] == 'rviz/Group':
            found += displays_of(display, kind)
    return found


class Launch(Process):
    """roslaunch, which ends its nodes when it is interrupted."""

    def _kill(self):
        if not self.ended():
            self.interrupt()
            self.wait()
        super()._kill()


class Looking(NodeTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.seen = os.path.join(self.folder, 'seen')
        self.temporary = os.path.join(self.folder, 'tmp')
        for name in ('seen', 'tmp', 'bin'):
            os.mkdir(os.path.join(self.folder, name))
        rviz = self.write('bin/rviz', STAND_IN)
        os.chmod(rviz, 0o755)
        self.environment = {'RVIZ_SEEN': self.seen, 'TMPDIR': self.temporary,
                            'PATH': os.path.dirname(rviz) + ':' + os.environ['PATH']}

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
        return path

    def call(self, *words, **environment):
        return subprocess.run([executable('rviz_for_robot'), *words], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True,
                              env=dict(os.environ, **environment))

    def config(self, *words, **environment):
        """The printed configuration, below its root."""
        done = self.call('--print', *words, **environment)
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        return yaml.safe_load(done.stdout)['Visualization Manager']

    def assertRefused(self, done, *parts, code=1):
        self.assertEqual(done.returncode, code)
        self.assertEqual(done.stdout, '')
        line, = done.stderr.splitlines()
        self.assertTrue(line.startswith('rviz_for_robot: '), line)
        for part in parts:
            self.assertIn(part, line)

    def assertLooksWell(self, config):
        """Arrows that can be seen, and a camera that is not far away."""
        self.assertTrue(displays_of(config, 'rviz/WrenchStamped'))
        for display in displays_of(config, 'rviz/WrenchStamped'):
            for key in ('Arrow Width', 'Force Arrow Scale', 'Torque Arrow Scale'):
                self.assertTrue(0 < float(display[key]) < 1e9, key)
        camera = config['Views']['Current']
        self.assertGreater(float(camera.get('Distance', camera.get('Scale'))), 0)

    def test_examples_have_an_arrow_for_each_joint_and_closure(self):
        for name, reactions in EXAMPLES.items():
            with self.subTest(example=name):
                scene = yaml.safe_load(read('..', '..', 'config', name + '_scene.yaml'))
                path = '%s/urdf/%s.urdf' % (ROOT, ROBOTS.get(name, name))
                robot = ElementTree.parse(path).getroot()
                config = self.config('--scene', '%s/config/%s_scene.yaml' % (ROOT, name), path)
                arrows = displays_of(config, 'rviz/WrenchStamped')
                shown = [display['Name'] for display in arrows]
                wanted = [joint.get('name') for joint in robot.findall('joint')
                          if joint.get('type') != 'fixed']
                wanted += [closure['name'] for key in ('closures', 'rolling', 'contacts', 'cylinders')
                           for closure in scene.get(key, [])]
                if scene.get('root') == 'moving':
                    wanted = scene['reactions']
                self.assertEqual(sorted(shown), sorted(wanted))
                if reactions is not None:
                    self.assertEqual(shown, reactions)
                self.assertEqual([display['Topic'] for display in arrows],
                                 ['/inverse_dynamics/reaction/' + joint for joint in shown])
                children = {link.get('link') for link in robot.findall('joint/child')}
                root, = {link.get('name') for link in robot.findall('link')} - children
                self.assertEqual(config['Global Options']['Fixed Frame'], root)
                self.assertEqual(displays_of(config, 'rviz/MarkerArray')[0]['Marker Topic'],
                                 '/inverse_dynamics/markers')
                self.assertLooksWell(config)

    def test_the_camera_looks_at_the_middle_of_the_model(self):
        # Three rods of 2 m, one on the other, seen from where all of them are in the picture.
        links = '<link name="l0"/>'
        for i in range(1, 4):
            links += LINK % ('l%d' % i) + (JOINT % ('j%d' % i, 'l%d' % (i - 1), 'l%d' % i)).replace(
                'xyz="0.1 0 0"', 'xyz="0 0 2"').replace('0 1 0', '1 0 0' if i == 2 else '0 1 0')
        camera = self.config(self.write('tower.urdf', '<robot name="t">%s</robot>' % links))['Views'][
            'Current']
        self.assertEqual(camera['Class'], 'rviz/Orbit')
        focus = [float(camera['Focal Point'][axis]) for axis in 'XYZ']
        distance = float(camera['Distance'])
        # Half of the field of view is 22.5 degrees: all six metres are within it.
        self.assertLess(6 - focus[2], distance * 0.41)
        self.assertLess(focus[2], distance * 0.41)
        self.assertLess(distance, 30)

    def test_whatever_the_node_reads(self):
        for name, text in (
                ('prefix_without_a_namespace',
                 '<robot name="r"><gz:clock name="t"/>' + ONE_JOINT + '</robot>'),
                ('line_before_the_declaration', '\n<?xml version="1.0"?>\n' + ROBOT),
                ('default_namespace', ROBOT.replace('name="r"', 'name="r" xmlns="http://x.org"')),
                ('a name with spaces and \' quotes', ROBOT)):
            with self.subTest(name):
                config = self.config(self.write(name + '.urdf', text))
                self.assertEqual([d['Name'] for d in displays_of(config, 'rviz/WrenchStamped')],
                                 ['pin'])
                self.assertEqual(config['Global Options']['Fixed Frame'], 'base')

    def test_a_ring_of_links_is_refused_in_one_line(self):
        ring = self.write('ring.urdf', '<robot name="ring"><link name="root"/>%s%s%s%s</robot>' % (
            LINK % 'a', LINK % 'b', JOINT % ('j1', 'a', 'b'), JOINT % ('j2', 'b', 'a')))
        self.assertRefused(self.call('--print', ring), 'ring.urdf', "'a'", 'loop')

    def test_a_chain_of_ten_thousand_links(self):
        names = ['l%d' % i for i in range(10001)]
        chain = LINK % names[0] + ''.join(
            LINK % child + JOINT % ('j' + child, parent, child)
            for parent, child in zip(names, names[1:]))
        done = self.call('--print', self.write('chain.urdf', '<robot name="c">%s</robot>' % chain))
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.assertEqual(done.stdout.count('Class: rviz/WrenchStamped'), 10000)
        self.assertEqual(done.stdout.count('Topic: /inverse_dynamics/reaction/jl'), 10000)

    def test_light_parts_of_a_heavy_robot_have_arrows_of_their_own_scale(self):
        heavy = ROBOT.replace('<link name="base"/>', (LINK % 'base').replace('mass value="1"',
                                                                           'mass value="1000"'))
        scales = [float(displays_of(self.config(self.write('%d.urdf' % i, text)),
                                    'rviz/WrenchStamped')[0]['Force Arrow Scale'])
                  for i, text in enumerate((ROBOT, heavy))]
        # The base's centre of mass makes the model somewhat longer.
        self.assertLess(abs(scales[1] / scales[0] - 1), 0.5)

    def test_without_gravity_arrows_are_of_some_length(self):
        scene = self.write('scene.yaml', 'gravity: [0, 0, 0]\n')
        config = self.config('--scene=' + scene, self.write('robot.urdf', ROBOT))
        self.assertLooksWell(config)
        # 1 rad/s^2 at 0.1 m and 1 kg: 0.1 N are three tenths of the size; RViz adds a head.
        arrow, = displays_of(config, 'rviz/WrenchStamped')
        camera = config['Views']['Current']
        size = float(camera['Distance']) / 1.3
        self.assertLess(abs(0.1 * 1.3 * float(arrow['Force Arrow Scale']) / (0.3 * size) - 1), 1e-6)

    def test_options(self):
        robot = self.write('robot.urdf', ROBOT)
        config = self.config('--frame', 'world', '--node', 'other', '--frame-prefix', 'left/', robot)
        self.assertEqual(config['Global Options']['Fixed Frame'], 'world')
        self.assertEqual(config['Views']['Current']['Target Frame'], 'left/base')
        self.assertEqual(displays_of(config, 'rviz/RobotModel')[0]['TF Prefix'], 'left')
        self.assertEqual(displays_of(config, 'rviz/WrenchStamped')[0]['Topic'],
                         '/other/reaction/pin')
        for frame in ('auto', ''):
            config = self.config('--frame=' + frame, '--scene=none', robot)
            self.assertEqual(config['Global Options']['Fixed Frame'], 'base')
        template = yaml.safe_load(read('..', '..', 'config', 'inverse_dynamics.rviz'))
        template['Visualization Manager']['Global Options']['Frame Rate'] = 7
        config = self.config('--template', self.write('my.rviz', yaml.safe_dump(template)), robot)
        self.assertEqual(config['Global Options']['Frame Rate'], 7)

    def test_errors_are_one_line(self):
        robot = self.write('robot.urdf', ROBOT)
        self.assertRefused(self.call(self.folder + '/none.urdf'), 'none.urdf', 'No such file')
        self.assertRefused(self.call('--print', '--scene', robot, robot), 'robot.urdf')
        scene = self.write('scene.yaml', 'reactions: [pni]\n')
        self.assertRefused(self.call('--print', '--scene', scene, robot), 'pni')
        for text in ('- 1\n', 'a: [\n', 'Visualization Manager: {Displays: 3}\n', '',
                     'Visualization Manager: {Displays: [{Class: rviz/Grid}]}\n'):
            with self.subTest(template=text):
                template = self.write('my.rviz', text)
                self.assertRefused(self.call('--print', '--template', template, robot), 'my.rviz')
        self.assertRefused(self.call('--sene', 'x', robot), '--sene', code=2)
        self.assertRefused(self.call('--scene'), '--scene', code=2)
        self.assertRefused(self.call('--node', 'a b', robot), 'a b')
        self.assertRefused(self.call(robot, '__ns:=a b'), 'a b')
        self.assertRefused(self.call(robot, PATH=self.temporary), 'rviz', 'No such file')
        self.assertRefused(self.call('__ns:=/nobody_is_here'), 'robot_description',
                           '/nobody_is_here')
        self.assertRefused(self.call(ROS_MASTER_URI='http://localhost:1'), 'http://localhost:1')
        with open('/dev/full', 'w') as full:
            done = subprocess.run([executable('rviz_for_robot'), '--print', robot], stdout=full,
                                  stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn('No space left', done.stderr)
        usage = self.call('--help')
        self.assertEqual((usage.returncode, usage.stderr), (0, ''))
        self.assertIn('usage: rviz_for_robot', usage.stdout)

    def test_two_robots_in_two_namespaces(self):
        master = rosgraph.Master('/test')
        for side, robot, scene in (('left', ARM, {'reactions': ['elbow', 'ground']}),
                                   ('right', ROBOT, {'reactions': 'all'})):
            node = Node(self, robot, {'scene': scene, 'frame_prefix': side + '/'})
            wait_until(lambda: any(node.name in nodes for topic, nodes in master.getSystemState()[0]
                                   if topic.startswith(node.name + '/')), 'the topics of ' + node.name)
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
                             ['/%s/inverse_dynamics/reaction/joint_%d' % (side, i)
                              for i in range(1, 7)])
            self.assertEqual(displays_of(config, 'rviz/RobotModel')[0]['Robot Description'],
                             '/%s/robot_description' % side)
        wrench.wait(500)
        stamps = {message.header.stamp.to_nsec() for message in wrench.messages()}
        first, last = min(stamps), max(stamps)
        callers = rosgraph.Master('/test').getSystemState()[1]
        self.assertTrue(any(topic == '/left/inverse_dynamics/effort' and
                            '/left/robot_state_publisher' in nodes for topic, nodes in callers))
        # Those of the other arm are of its own instants.
        theirs = {m.header.stamp.to_nsec() for m in effort.messages()}
        moved = {t.header.stamp.to_nsec() for m in frames.messages() for t in m.transforms}
        shown = {stamp for stamp in moved & theirs if first <= stamp <= last}
        self.assertGreater(len(shown), 10)
        self.assertLessEqual(shown, stamps)

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
        types = wait_until(lambda: {topic: kind for topic, kind in master.getTopicTypes()
                                    if topic.startswith(node.name + '/reaction/joint_6')}
                           and dict(master.getTopicTypes()), 'the topics')
        joints = EXAMPLES['six_axis_arm']

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
