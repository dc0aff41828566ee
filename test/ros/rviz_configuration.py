"""rviz_for_robot, and what is in the configurations that it prints, for ROS tests."""
import os
import subprocess
import tempfile

import yaml

from node_under_test import NodeTest, executable

LINK = ('<link name="%s"><inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.01" ixy="0" '
        'ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>')
JOINT = ('<joint name="%s" type="continuous"><parent link="%s"/><child link="%s"/>'
         '<origin xyz="0.1 0 0"/><axis xyz="0 1 0"/></joint>')
ONE_JOINT = '<link name="base"/>' + LINK % 'arm' + JOINT % ('pin', 'base', 'arm')
ROBOT = '<robot name="r">' + ONE_JOINT + '</robot>'
SIX_AXIS_ARM = ['joint_%d' % i for i in range(1, 7)]


def displays_of(config, kind):
    """All displays of a class, those in groups included."""
    found = []
    for display in config['Displays']:
        if display['Class'] == kind:
            found.append(display)
        if display['Class'] == 'rviz/Group':
            found += displays_of(display, kind)
    return found


class RvizTest(NodeTest):
    """With a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

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
