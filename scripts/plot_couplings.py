#!/usr/bin/python3
"""Draws the examples with couplings and teeth: motions, efforts and tooth forces.

Usage: plot_couplings.py OFFLINE_TOOL FOLDER [EXAMPLE ...]

OFFLINE_TOOL is the executable inverse_dynamics_offline. For each example it computes the motion of
config/<example>_trajectory.yaml and draws FOLDER/<example>.png.
"""
import os
import sys
import tempfile

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen first)
import numpy as np
import yaml

from plot_closed_loops import PACKAGE, STYLE, compute, draw_all

# For each example: title, and for each panel its title, unit, and curves: column, label, factor.
EXAMPLES = {
    'coupled_wrist': ('Coupled wrist: motors 5 and 6 in the forearm', [
        ('Positions of the joints', 'rad', [('position.joint_5', 'joint_5', 1),
                                            ('position.joint_6', 'joint_6', 1)]),
        ('Positions of the motors', 'turns', [('position.motor_5', 'motor_5', 0.5 / np.pi),
                                              ('position.motor_6', 'motor_6', 0.5 / np.pi)]),
        ('Efforts of the motors', 'N m', [('effort.motor_5', 'motor_5', 1),
                                          ('effort.motor_6', 'motor_6', 1)]),
        ('What the gears exert at the motors', 'N m', [('effort.gear_5', 'gear_5', 1),
                                                       ('effort.gear_6', 'gear_6', 1)])]),
    'planetary_gear': ('Planetary gear: the sun drives, the carrier bears a load', [
        ('Positions', 'turns', [('position.sun_joint', 'sun', 0.5 / np.pi),
                                ('position.carrier_joint', 'carrier', 0.5 / np.pi),
                                ('position.planet_1_joint', 'planet, on the carrier', 0.5 / np.pi)]),
        ('Effort of the motor', 'N m', [('effort.sun_joint', 'sun', 1)]),
        ('Force of the sun on a planet (root axes)', 'N',
         [('reaction.sun_1.f' + x, 'f' + x, 1) for x in 'xyz']),
        ("Force in a planet's bearing (root axes)", 'N',
         [('reaction.planet_1_joint.f' + x, 'f' + x, 1) for x in 'xyz'])]),
}


def draw(tool, name, path):
    title, panels = EXAMPLES[name]
    with open(os.path.join(PACKAGE, 'config', name + '_trajectory.yaml')) as file:
        trajectory = yaml.safe_load(file)
    with tempfile.TemporaryDirectory() as folder:
        t, _, results = compute(tool, name, trajectory, folder, ['--positions'])
    plt.rcParams.update(STYLE)
    figure, axes = plt.subplots(2, 2, figsize=(12, 5.8), sharex=True)
    figure.suptitle(title, fontsize=12)
    for panel, (heading, unit, curves) in zip(axes.T.flat, panels):
        for column, label, factor in curves:
            panel.plot(t, factor * results[column], label=label)
        panel.set_title(heading)
        panel.set_ylabel('[%s]' % unit)
        panel.legend(loc='upper left', bbox_to_anchor=(1.01, 1), borderaxespad=0, frameon=False)
    for panel in axes[1]:
        panel.set_xlabel('t [s]')
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    plt.close(figure)


if __name__ == '__main__':
    sys.exit(draw_all(sys.argv[1:], __doc__, EXAMPLES, draw))
