#!/usr/bin/python3
"""~markers: reactions as text at their origins, and a legend that is true of rviz_for_robot's arrows."""
import re
import subprocess

from geometry_msgs.msg import WrenchStamped
import numpy as np
from trajectory_msgs.msg import JointTrajectory
from visualization_msgs.msg import Marker, MarkerArray
import yaml

from node_under_test import (EPOCH, Node, NodeTest, executable, read, ros_time, run,
                             trajectory_point, vector)

ARM = read('data', 'arm.urdf')
COORDINATES = ['shoulder', 'elbow', 'slide']
MOTION = (dict(shoulder=0.7, elbow=-1.3, slide=0.11), dict(shoulder=1.2, elbow=-0.8, slide=0.3),
          dict(shoulder=-2.0, elbow=3.0, slide=0.9))
REACTIONS = ['shoulder', 'elbow', 'slide', 'ground']
FRAMES = dict(shoulder='left/upper_arm', elbow='left/forearm', slide='left/hand', ground='left/stand')
SCENE = {'reactions': REACTIONS}
TEXT = re.compile(r'\n*(\S+): (\S+) N, (\S+) N m\n*')
THREE_DIGITS = 0.005
LENGTHS = 1e-5  # RViz's parameters and markers, relative


def trajectory(count):
    message = JointTrajectory(joint_names=COORDINATES)
    message.header.stamp = ros_time(EPOCH)
    message.points = [trajectory_point(i * 1000000, COORDINATES, MOTION) for i in range(count)]
    return message


class Markers(NodeTest):
    def start(self, *topics, scene=None, **parameters):
        self.node = Node(self, ARM, dict({'scene': scene or SCENE, 'frame_prefix': 'left/'},
                                         **parameters))
        self.feed = self.node.feed('joint_trajectory', JointTrajectory)
        recorders = [self.node.record(topic, MarkerArray if topic == 'markers' else WrenchStamped)
                     for topic in topics]
        self.node.wait_for_plan(*topics)
        return recorders

    def test_a_text_for_each_reaction_at_its_origin(self):
        markers, *wrenches = self.start('markers', *['reaction/' + name for name in REACTIONS])
        self.feed.publish(trajectory(1))
        message = markers.wait(1)[0]
        texts = {marker.ns: marker for marker in message.markers
                 if marker.type == Marker.TEXT_VIEW_FACING and marker.ns != 'legend'}
        self.assertEqual(set(texts), set(REACTIONS))
        for name, recorder in zip(REACTIONS, wrenches):
            wrench, = recorder.wait(1)
            marker = texts[name]
            with self.subTest(reaction=name):
                self.assertEqual(marker.header.frame_id, FRAMES[name])
                self.assertEqual(marker.header.frame_id, wrench.header.frame_id)
                self.assertEqual(marker.header.stamp, wrench.header.stamp)
                self.assertEqual(vector(marker.pose.position), [0, 0, 0])
                self.assertEqual(marker.pose.orientation.w, 1)
                self.assertGreater(marker.scale.z, 0)
                self.assertTrue(marker.frame_locked)
                said, force, moment = TEXT.fullmatch(marker.text).groups()
                self.assertEqual(said, name)
                for text, exact in ((force, wrench.wrench.force), (moment, wrench.wrench.torque)):
                    exact = np.linalg.norm(vector(exact))
                    self.assertGreater(exact, 0.1)
                    self.assertLessEqual(abs(float(text) - exact), THREE_DIGITS * exact, text)

    def test_arrows_at_the_origins(self):
        markers, *wrenches = self.start('markers', *['reaction/' + name for name in REACTIONS])
        self.feed.publish(trajectory(1))
        message = markers.wait(1)[0]
        legend = [marker for marker in message.markers
                  if marker.ns == 'legend' and marker.type == Marker.ARROW]
        for name, recorder in zip(REACTIONS, wrenches):
            wrench, = recorder.wait(1)
            arrows = {marker.id: marker for marker in message.markers if marker.ns == name}
            self.assertEqual(set(arrows), {0, 1, 2})
            for arrow, exact, scale in ((arrows[1], wrench.wrench.force, legend[0]),
                                        (arrows[2], wrench.wrench.torque, legend[1])):
                with self.subTest(reaction=name, arrow=arrow.id):
                    self.assertEqual(arrow.type, Marker.ARROW)
                    self.assertEqual((arrow.header.frame_id, arrow.header.stamp),
                                     (wrench.header.frame_id, wrench.header.stamp))
                    self.assertTrue(arrow.frame_locked)
                    self.assertEqual(arrow.color, scale.color)
                    self.assertEqual(vector(arrow.points[0]), [0, 0, 0])
                    value = float(next(marker.text for marker in message.markers
                                       if marker.ns == 'legend' and marker.id == scale.id + 1)
                                  .split()[0])
                    length = np.linalg.norm(np.array(vector(scale.points[1])) -
                                            vector(scale.points[0]))
                    expected = np.array(vector(exact)) * length / value
                    if arrow.action == Marker.DELETE:
                        self.assertLessEqual(np.linalg.norm(expected), arrow.scale.x)
                    else:
                        self.assertClose(vector(arrow.points[1]), expected, LENGTHS, 'its end')
        self.assertEqual(sum(marker.action == Marker.ADD for marker in message.markers
                             if marker.type == Marker.ARROW and marker.ns in REACTIONS), 8)

    def test_a_legend_of_the_lengths_of_arrows(self):
        markers, = self.start('markers')
        self.feed.publish(trajectory(1))
        legend = [marker for marker in markers.wait(1)[0].markers if marker.ns == 'legend']
        printed = subprocess.run([executable('rviz_for_robot'), '--print',
                                  '__ns:=' + self.node.namespace], stdout=subprocess.PIPE,
                                 check=True, universal_newlines=True).stdout
        displays = yaml.safe_load(printed)['Visualization Manager']['Displays']
        arrows = next(d for d in displays if d['Name'] == 'Reactions')['Displays'][0]
        self.assertEqual([marker.type for marker in legend],
                         [Marker.ARROW, Marker.TEXT_VIEW_FACING] * 2)
        self.assertEqual(sorted(marker.id for marker in legend), [3, 4, 5, 6])
        for arrow, text, unit, scale in zip(legend[::2], legend[1::2], ('N', 'N m'),
                                            ('Force Arrow Scale', 'Torque Arrow Scale')):
            self.assertEqual(arrow.header.frame_id, 'left/stand')
            self.assertEqual(text.header.frame_id, 'left/stand')
            value, said = text.text.split(' ', 1)
            self.assertEqual(said, unit)
            start, end = (np.array(vector(point)) for point in arrow.points)
            # The head of RViz's arrow is three tenths of the shaft, whose length the scale gives.
            length = 1.3 * float(arrows[scale]) * float(value)
            self.assertLessEqual(abs(np.linalg.norm(end - start) - length), LENGTHS * length)

    def test_no_more_messages_than_asked_for(self):
        markers, elbow = self.start('markers', 'reaction/elbow', marker_rate=0.001)
        self.feed.publish(trajectory(2000))
        self.assertEqual(len(elbow.wait(2000)), 2000)
        # The one of the first sample came before those of the others.
        message, = markers.wait(1)
        self.assertEqual(message.markers[0].header.stamp.to_nsec(), EPOCH)

    def test_a_rate_that_cannot_be(self):
        for rate in (0, -1, 1e4):
            with self.subTest(rate=rate):
                node = Node(self, ARM, {'marker_rate': rate})
                self.assertNotEqual(node.wait(), 0)
                fatal, = node.lines('FATAL')
                self.assertIn('marker_rate', fatal)
                self.assertIn('not from 0.001 to 1000', fatal)

    def test_without_subscribers_nothing_is_computed(self):
        self.start('reaction/elbow')
        values = self.node.diagnostics()
        self.assertIn('1 reactions in child axes', values['computed'])


if __name__ == '__main__':
    run(Markers)
