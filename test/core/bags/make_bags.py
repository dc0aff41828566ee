#!/usr/bin/env python3
"""Writes the bags beside this program by rosbag, and a CSV by rostopic, for tests without ROS.

Their joint states, message i of COUNT (of the parts: every tenth of 10 COUNT): stamp START + 10 ms i, received 1 ms later; joints as named
below, joint j at (j + 1) (i / 100)^2, its velocity the derivative, its effort 10 (j + 1).
"""
import pathlib
import subprocess

import genpy
import rosbag
from sensor_msgs.msg import JointState
from std_msgs.msg import String

HERE = pathlib.Path(__file__).resolve().parent
START = 1600000000123456789  # ns
COUNT = 40


def time_of(nanoseconds):
    return genpy.Time(nanoseconds // 10**9, nanoseconds % 10**9)


def joint_state(i, names, places):
    message = JointState()
    message.header.stamp = time_of(START + 10**7 * i)
    message.name = names
    message.position = [(j + 1) * (i / 100)**2 for j in places]
    message.velocity = [(j + 1) * 2 * i / 100 for j in places]
    message.effort = [10 * (j + 1) for j in places]
    return message


def write(name, messages, compression="none"):
    """Writes (topic, i, message) with many chunks, so that several are read."""
    with rosbag.Bag(str(HERE / name), "w", compression=compression, chunk_threshold=1000) as bag:
        for topic, i, message in messages:
            bag.write(topic, message, time_of(START + 10**7 * i + 10**6))


def main():
    hinge = [("/joint_states", i, joint_state(i, ["hinge"], [0])) for i in range(COUNT)]
    for compression in ("none", "bz2", "lz4"):
        write(f"{compression}.bag", hinge, compression)
    slow = [("/joint_states", i, joint_state(i, ["hinge"], [0])) for i in range(0, 10 * COUNT, 10)]
    write("part_0.bag", slow[:13])
    write("part_1.bag", slow[13:30])
    write("part_2.bag", slow[30:])
    two = []
    for i in range(COUNT):
        two += [(f"/{robot}/joint_states", i, joint_state(i, ["hinge"], [place]))
                for place, robot in enumerate(["left", "right"])]
        two.append(("/note", i, String(data="no motion")))
    write("two_robots.bag", two)
    mixed = []
    for i in range(COUNT):
        names, places = (["arm", "hinge"], [1, 0]) if i % 2 else (["hinge", "arm"], [0, 1])
        mixed.append(("/joint_states", i, joint_state(i, names, places)))
        mixed.append(("/joint_states", i, joint_state(i, ["finger"], [7])))
    write("mixed.bag", mixed)
    echo = subprocess.run(["/usr/bin/rostopic", "echo", "-b", str(HERE / "mixed.bag"), "-p",
                           "/joint_states"], check=True, stdout=subprocess.PIPE).stdout
    (HERE / "echo.csv").write_bytes(echo)
    write("notes.bag", [("/note", 0, String(data="no motion"))])


if __name__ == "__main__":
    main()
