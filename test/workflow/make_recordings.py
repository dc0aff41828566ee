"""Bags with joint states of the six-axis arm, each of another motion, written by rosbag."""
import math
import pathlib
import random

import genpy
import rosbag
from sensor_msgs.msg import JointState

JOINTS = ['joint_%d' % i for i in range(1, 7)]
RATE = 100  # Hz
SECONDS = 4


def make_recordings(folder, count, name_of, seconds=SECONDS):
    """Writes `count` bags of `seconds` at 100 Hz, always the same ones, with encoder noise."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True)
    for number in range(count):
        chance = random.Random(number)
        waves = [[(chance.uniform(0.1, 0.4), 2 * math.pi * chance.uniform(0.1, 1.2), chance.uniform(0, 6))
                  for _ in range(3)] for _ in JOINTS]
        with rosbag.Bag(str(folder / name_of(number)), 'w') as bag:
            for i in range(int(seconds * RATE)):
                t = i / RATE
                message = JointState(name=JOINTS)
                message.header.stamp = genpy.Time.from_sec(1000 + t)
                message.position = [sum(a * math.sin(w * t + p) for a, w, p in of) + chance.gauss(0, 1e-5)
                                    for of in waves]
                message.velocity = [sum(a * w * math.cos(w * t + p) for a, w, p in of) + chance.gauss(0, 1e-3)
                                    for of in waves]
                bag.write('/joint_states', message, message.header.stamp)
