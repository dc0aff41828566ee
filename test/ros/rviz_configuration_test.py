#!/usr/bin/python3
"""The configuration that rviz_for_robot writes: arrows, camera, scales, options, what is refused."""
import os
import subprocess
import xml.etree.ElementTree as ElementTree

import yaml

from node_under_test import HERE, executable, read, run
from rviz_configuration import JOINT, LINK, ONE_JOINT, ROBOT, SIX_AXIS_ARM, RvizTest, displays_of

ROOT = os.path.dirname(os.path.dirname(HERE))
EXAMPLES = {
    'composed_pendulum': ['joint_1', 'joint_2'],
    'six_axis_arm': SIX_AXIS_ARM,
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
    'arm_on_a_ship': ['ground'] + SIX_AXIS_ARM,
    'balance_board': ['ground', 'ankle', 'knee', 'hip', 'waist'],
    'quadruped': ['ground'],
}
# Of examples that do not have a description of their own.
ROBOTS = {'arm_on_a_ship': 'six_axis_arm'}


class Configurations(RvizTest):
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
        self.assertRefused(self.call(robot, PATH=self.folder), 'rviz', 'No such file')
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


if __name__ == '__main__':
    run(Configurations)
