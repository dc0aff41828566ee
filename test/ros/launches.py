"""roslaunch as a user starts it: in a clean shell, from a folder with an odd name."""
import json
import os
import shutil
import stat
import subprocess
import tempfile
import xmlrpc.client

import rosbag
import rosgraph
import rospy

from node_under_test import PACKAGE, NodeTest, Process, Recorder, read, wait_until

ARM = read('data', 'arm.urdf')
# What a clean shell has.
CLEAN = {'HOME': os.path.expanduser('~'), 'PATH': '/usr/bin:/bin'}
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


class LaunchTest(NodeTest):
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
            wait_until(lambda: self.bags_listen(recorder.topic) or launch.ended(),
                       lambda: 'bags to listen to %s; %s' % (recorder.topic, launch.output()))
            self.assertFalse(launch.ended(), launch.output())
            recorder.wait(len(recorder.raw) + 20)

    def bags_listen(self, topic):
        """Whether all nodes that record the topic are connected to all that publish it."""
        master = rosgraph.Master('/test')
        publishers, subscribers, _ = (dict(part) for part in master.getSystemState())
        bags = {node for node in subscribers.get(topic, []) if node.endswith('/recorder')}
        connected = []
        for node in publishers.get(topic, []):
            _, _, bus = xmlrpc.client.ServerProxy(master.lookupNode(node)).getBusInfo('/test')
            connected.append(bags <= {entry[1] for entry in bus
                                      if entry[2] == 'o' and entry[4] == topic})
        return bool(bags and connected) and all(connected)

    def motion(self):
        """A motion of the arm, which rests at zero; returns the name of its file."""
        self.write('the table\'s "t".csv', 'time,position.shoulder,position.elbow,position.slide\n' +
                   ''.join('%r,0,0,0\n' % (0.05 * row) for row in range(20)))
        return self.write('the motion\'s "m".yaml', MOTION)

    def topics(self, bag):
        with rosbag.Bag(os.path.join(self.folder, bag)) as content:
            return set(content.get_type_and_topic_info().topics)
