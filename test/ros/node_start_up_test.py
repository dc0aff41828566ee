#!/usr/bin/python3
"""What the node refuses to start on, one line each, and what it starts with all the same."""
import re
import socketserver
import threading
import xmlrpc.client
import xmlrpc.server

import rosgraph
import rospy
import yaml
from sensor_msgs.msg import JointState

from node_under_test import Node, NodeTest, Process, executable, joint_state, read, run
from refused_starts import (BAD_PARAMETERS, BAD_ROBOTS, DOUBTFUL, GOOD, HINGE, INERTIAL, NEW_ONES, STRICT, WRIST,
                            robot, with_inertial)


class WatchedMaster(socketserver.ThreadingMixIn, xmlrpc.server.SimpleXMLRPCServer):
    """Stands between a node and the master and remembers what the node registers."""

    daemon_threads = True

    class Handler(xmlrpc.server.SimpleXMLRPCRequestHandler):
        protocol_version = 'HTTP/1.1'
        rpc_paths = ()
        # Or small answers wait for an acknowledgement that is delayed.
        disable_nagle_algorithm = True

    def __init__(self):
        super().__init__(('localhost', 0), self.Handler, logRequests=False, allow_none=True)
        self.uri = 'http://localhost:%d' % self.server_address[1]
        self.registered = []
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def _dispatch(self, method, parameters):
        if method in ('registerPublisher', 'registerSubscriber'):
            self.registered.append((parameters[0], method, parameters[1]))
        with xmlrpc.client.ServerProxy(rosgraph.get_master_uri()) as master:
            return getattr(master, method)(*parameters)

    def handle_error(self, request, client_address):
        """A node that ends may leave a call behind; whatever else goes wrong shows in the node."""

    def topics(self, node):
        """What a node has ever registered, without every node's own log."""
        return [entry[1:] for entry in list(self.registered)
                if entry[0] == node and entry[2] != '/rosout']


class StartUp(NodeTest):
    @classmethod
    def setUpClass(cls):
        cls.master = WatchedMaster()

    @classmethod
    def tearDownClass(cls):
        cls.master.shutdown()
        cls.master.server_close()

    def start(self, description, parameters=None, arguments=()):
        return Node(self, description, parameters, arguments=arguments,
                    environment={'ROS_MASTER_URI': self.master.uri})

    def expect_refusal(self, node, parts):
        self.assertEqual(node.wait(), 1, node.output())
        lines = node.lines('FATAL')
        self.assertEqual(len(lines), 1, node.output())
        for part in parts:  # in which ~ stands for the node's own name
            self.assertIn(re.sub('(^| )~', lambda match: match[1] + node.name + '/', part), lines[0])
        # A line, and nothing else: what is wrong with a description is not said twice.
        self.assertEqual(node.output().count('\n'), 1, node.output())
        self.assertEqual(self.master.topics(node.name), [])

    def expect_start(self, node, warnings):
        """Runs, warns of exactly these, each list of parts in a line, and ends when asked to."""
        node.diagnostics()
        # The watching master has seen it all.
        topics = self.master.topics(node.name)
        self.assertIn(('registerPublisher', node.name + '/effort'), topics)
        self.assertIn(('registerSubscriber', node.namespace + '/joint_states'), topics)
        self.assertIn(('registerSubscriber', node.namespace + '/joint_trajectory'), topics)
        node.interrupt()
        self.assertEqual(node.wait(), 0, node.output())
        lines = node.lines('WARN')
        self.assertEqual(len(lines), len(warnings), node.output())
        for line, parts in zip(lines, warnings):
            for part in parts:
                self.assertIn(part, line)
        self.assertEqual(node.lines('FATAL') + node.lines('ERROR'), [])

    def test_good_robot(self):
        self.expect_start(self.start(GOOD), [])

    def test_slender_rods_are_not_doubted(self):
        self.expect_start(self.start(read('..', '..', 'urdf', 'composed_pendulum.urdf')), [])

    def test_what_is_not_read_is_warned_of(self):
        loop = ('<loop_joint name="k" type="revolute"><link1 link="base"/><link2 link="hand"/>'
                '</loop_joint>')
        description = robot(HINGE, WRIST, loop, inertial=INERTIAL + '<visual><geometry/></visual>')
        self.expect_start(self.start(description),
                          [['<loop_joint name=', 'not read', 'closures: [{name: k, type: revolute']])

    def test_names_with_control_characters_stay_in_their_line(self):
        description = (GOOD.replace('name="hinge"', 'name="hin&#10;ge&#27;[31m"')
                       .replace('name="tester"', 'name="te&#10;ster"'))
        node = self.start(description)
        node.feed('joint_states', JointState).publish(joint_state(1000000000, {'wrist': 0.1}))
        values = node.diagnostics(lambda values: values['joints waited for'] != 'none')
        self.assertEqual(values['joints waited for'], r'hin\nge\x1b[31m')
        status = node.statuses()[-1]
        self.assertEqual(status.hardware_id, r'te\nster')
        for text in [status.name, status.message, *values.keys(), *values.values()]:
            self.assertTrue(text.isprintable(), repr(text))
        node.interrupt()
        self.assertEqual(node.wait(), 0, node.output())
        self.assertIn(r"Robot 'te\nster' from", node.output())
        for line in node.output().splitlines():
            self.assertNotIn('\x1b[31m', line)

    def test_inertias_of_another_unit_are_doubted(self):
        self.expect_start(self.start(with_inertial(ixx='11467', iyy='11467', izz='11467')),
                          [['link', 'radius of gyration', 'g mm^2']] * 2)

    def test_axis_of_another_length(self):
        description = GOOD.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 3"/>', 1)
        self.expect_start(self.start(description), [["joint 'hinge'", '(0, 0, 3)', 'unit length']])

    def test_robot_description_from_a_namespace_above(self):
        rospy.set_param('/robot_description', GOOD)
        self.addCleanup(rospy.delete_param, '/robot_description')
        node = self.start(None)
        self.expect_start(node, [])
        self.assertIn("Robot 'tester' from /robot_description: 2 coordinates (hinge, wrist)",
                      node.output())

    def test_default_parameters_are_the_documented_ones(self):
        documented = yaml.safe_load(read('..', '..', 'config', 'inverse_dynamics.yaml'))
        summaries = []
        for parameters in (None, documented):
            node = self.start(GOOD, parameters)
            self.expect_start(node, [])
            summaries.append(re.findall('2 coordinates.*', node.output()))
        self.assertIn('accelerations of joint states estimated 0.05 s behind the newest',
                      summaries[0][0])
        self.assertEqual(summaries[0], summaries[1])

    def test_help_names_every_parameter(self):
        process = Process(self, [executable('inverse_dynamics_node'), '--help'])
        self.assertEqual(process.wait(), 0)
        documented = yaml.safe_load(read('..', '..', 'config', 'inverse_dynamics.yaml'))
        for key, value in documented.items():
            for name in ['%s/%s' % (key, inner) for inner in value] \
                    if isinstance(value, dict) else [key]:
                self.assertRegex(process.output(), r'\n  ~%s +\S' % name)

    def test_old_parameters_are_refused_together_in_one_line(self):
        node = self.start(GOOD, {'estimator': {'window': 9, 'order': 3, 'lag': 4}})
        self.expect_refusal(node, ['~estimator/'] + NEW_ONES)

    def test_noises_and_joints_at_rest(self):
        estimator = {'position_noise': 1e-4, 'velocity_noise': 1, 'stamp_noise': 0, 'lag': 0,
                     'bandwidth': 'auto', 'use_velocity': False}
        rest = [{'name': 'wrist', 'position': '1e-2'}]
        node = self.start(GOOD, {'estimator': estimator, 'rest': rest, 'hold_after': 1})
        self.expect_start(node, [])
        self.assertIn('accelerations of joint states estimated 0 s behind', node.output())

    def test_scene_on_the_command_line(self):
        for argument in ('_scene:={gravity: [0, 1.5, -2], reactions: [wrist]}',
                         '_scene/gravity:=[0, 1.5, -2]'):
            node = self.start(GOOD, arguments=[argument])
            self.expect_start(node, [])
            self.assertIn('gravity [0, 1.5, -2] m/s^2', node.output())
            self.assertIn('scene from %s/scene' % node.name, node.output())

    def expect_one_line(self, arguments, part, environment=None):
        """What is wrong before there is a node that could say so."""
        process = Process(self, [executable('inverse_dynamics_node'), *arguments], environment)
        self.assertEqual(process.wait(), 1, process.output())
        self.assertEqual(len(process.lines('FATAL')), 1, process.output())
        self.assertIn(part, process.lines('FATAL')[0])
        self.assertEqual(process.output().count('\n'), 1, process.output())

    def test_names_that_ros_does_not_take(self):
        self.expect_one_line(['joint_states:=joint%states'], '[joint%states]')
        self.expect_one_line(['joint%states:=joint_states'], '[joint%states]')
        self.expect_one_line(['__name:=left/arm'], '[left/arm]')
        self.expect_one_line(['_sc%ene:=5'], '[~sc%ene]')

    def test_address_that_is_none(self):
        for address in ('nowhere', '', 'http://localhost', 'http://localhost:port', 'http://:11311'):
            self.expect_one_line([], "ROS_MASTER_URI: expected an address like "
                                 "http://localhost:11311, got '%s'" % address,
                                 {'ROS_MASTER_URI': address})
        self.expect_one_line(['__master:=nowhere'], "__master: expected an address like "
                             "http://localhost:11311, got 'nowhere'")

    def test_unknown_argument(self):
        self.expect_refusal(self.start(GOOD, arguments=['--robot']), ['unknown argument --robot'])


def add_tests():
    """A test for each entry of the tables."""
    def refused(description, parameters, parts):
        return lambda self: self.expect_refusal(self.start(description, parameters), parts)

    def warned(description, links, value):
        return lambda self: self.expect_start(self.start(description),
                                              [[link, value] for link in links])

    for name, (description, parts) in BAD_ROBOTS.items():
        setattr(StartUp, 'test_refuses_' + name, refused(description, None, parts))
    for name, (parameters, parts) in BAD_PARAMETERS.items():
        setattr(StartUp, 'test_refuses_' + name, refused(GOOD, parameters, parts))
    for name, (description, links, value) in DOUBTFUL.items():
        setattr(StartUp, 'test_refuses_when_strict_' + name,
                refused(description, STRICT, [links[0], value]))
        setattr(StartUp, 'test_starts_with_a_warning_' + name, warned(description, links, value))


add_tests()

if __name__ == '__main__':
    run(StartUp)
