#!/usr/bin/python3
"""identify.py from files to result, on recordings whose truth is known; and what it refuses."""
import contextlib
import csv
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import yaml

import simulated_recordings as simulated

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
import identify  # noqa: E402 (the folder has to be known first)
from identification import files  # noqa: E402
from identification.study import Study  # noqa: E402

TERMS = {'damping': [12, 15, 8, 2, 1.5, 1.2], 'coulomb': [9, 11, 6, 2.5, 1.8, 1.5],
         'rotor_inertia': [2.5, 3, 1.5, 0.2, 0.15, 0.12], 'offset': [1, -2, 0.7, -0.3, 0.2, 0.1]}
TERMS_SCENE = 'joints:\n' + ''.join(
    '  - {name: %s, coulomb_velocity: 0.02, %s}\n' % (
        name, ', '.join('%s: %g' % (kind, values[i]) for kind, values in TERMS.items()))
    for i, name in enumerate(simulated.JOINTS))
PAYLOAD = {'mass': 2.8, 'centre x': 0.02, 'centre y': -0.03, 'centre z': 0.11}
PAYLOAD_SCENE = 'payload: [{link: wrist_3, mass: 2.8, at: [0.02, -0.03, 0.11], inertia: [0.02, 0, 0, 0.015, 0, 0.012]}]\n'
NOISE = np.array([3, 5, 3, 0.8, 0.6, 0.4])  # N m: one or two hundredths of the arm's efforts
DEVIATIONS = 4  # that hardly any of some dozen numbers exceeds; three are for single ones


@unittest.skipUnless(simulated.tool(), 'the offline tool is not built')
class Recordings(unittest.TestCase):
    """The program, from files to result."""

    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        folder = cls.kept.name
        cls.motion = simulated.Motion(seconds=20, rate=100)
        cls.loaded = os.path.join(folder, 'loaded.csv')
        simulated.record(cls.loaded, cls.motion, simulated.efforts(folder, cls.motion, TERMS_SCENE + PAYLOAD_SCENE),
                         NOISE, 1)
        # Another motion, in which the last joint rests.
        cls.other = simulated.Motion(seed=8, seconds=20, rate=100)
        for values, rest in ((cls.other.q, 0.4), (cls.other.qd, 0), (cls.other.qdd, 0)):
            values[:, 5] = rest
        cls.empty_efforts = simulated.efforts(folder, cls.other, TERMS_SCENE)
        cls.empty = os.path.join(folder, 'empty.csv')
        simulated.record(cls.empty, cls.other, cls.empty_efforts, NOISE, 2)

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def words(self, arguments):
        return ['--tool', simulated.tool(), '--urdf', str(simulated.ARM), '--output',
                os.path.join(self.folder, 'out')] + list(arguments)

    def run_program(self, *arguments):
        """Runs it in this process, as what it imports takes longer than what it does."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = identify.main(self.words(arguments))
        return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())

    def found(self, *arguments):
        """What the program finds, by (parameter, of), with what it prints."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, '')
        with open(os.path.join(self.folder, 'out/parameters.csv'), newline='') as file:
            return {(row['parameter'], row['of']): row for row in csv.DictReader(file)}, result.stdout

    def out(self, name):
        return os.path.join(self.folder, 'out', name)

    def assert_near(self, rows, key, truth):
        value, deviation = (float(rows[key][column]) for column in ('value', 'deviation'))
        self.assertLess(abs(value - truth), DEVIATIONS * deviation, '%s: %g +- %g' % (key, value, deviation))
        self.assertEqual(rows[key]['status'], 'excited')

    def assert_accounted_for(self, said):
        """The variance of rows that were not fitted, by the files that were written; 0.6 before."""
        mean = [float(line.split()[-2]) for line in said.splitlines() if line.startswith('mean VAF')]
        self.assertEqual(len(mean), 2)
        self.assertGreater(mean[1], 0.97)

    def test_friction_rotors_and_payload_beside_the_truth(self):
        rows, said = self.found('--motion', self.loaded, '--fit', 'friction,offset,rotor,payload:wrist_3')
        for kind, values in TERMS.items():
            for name, truth in zip(simulated.JOINTS, values):
                if not rows[kind, name]['status'].startswith('not excited'):
                    self.assert_near(rows, (kind, name), truth)
            self.assert_near(rows, (kind, 'joint_1'), values[0])
        for what, truth in PAYLOAD.items():
            self.assert_near(rows, (what, 'payload of wrist_3'), truth)
        self.assertLess(abs(float(rows['mass', 'payload of wrist_3']['value']) / 2.8 - 1), 0.03)
        with open(self.out('scene.yaml')) as file:
            scene = yaml.safe_load(file)
        payload = scene['payload'][0]
        self.assertEqual(payload['link'], 'wrist_3')
        written = [payload['mass']] + payload['at']
        found = [float(rows[what, 'payload of wrist_3']['value']) for what in PAYLOAD]
        np.testing.assert_allclose(written, found, rtol=1e-6)  # the digits that are written
        self.assertEqual([entry['name'] for entry in scene['joints']], simulated.JOINTS)
        self.assertIn('rows that were not fitted:', said)
        self.assert_accounted_for(said)
        for name in ('report.md', 'efforts.png', 'whiteness.png'):
            self.assertGreater(os.path.getsize(self.out(name)), 500)
        # The files that are written say the same to the offline tool.
        check = subprocess.run([simulated.tool(), '--urdf', str(simulated.ARM), '--scene', self.out('scene.yaml'),
                                '--check'], stdout=subprocess.PIPE, text=True, check=False)
        self.assertEqual(check.returncode, 0)

    def test_what_the_motion_does_not_excite_is_named_and_left(self):
        rows, said = self.found('--motion', self.empty)
        for kind in ('damping', 'coulomb'):
            self.assertEqual(rows[kind, 'joint_6']['status'], 'not excited: the joint rests')
            self.assertEqual(float(rows[kind, 'joint_6']['value']), 0)
            self.assert_near(rows, (kind, 'joint_2'), TERMS[kind][1])
        with open(self.out('scene.yaml')) as file:
            text = file.read()
        self.assertIn('# coulomb of joint_6: not excited: the joint rests', text)
        last = [entry for entry in yaml.safe_load(text)['joints'] if entry['name'] == 'joint_6']
        self.assertTrue(all('coulomb' not in entry for entry in last))
        self.assertIn('not excited: the joint rests', said)

    def test_all_bodies_with_a_recording_without_the_payload(self):
        rows, said = self.found('--motion', self.loaded, '--unloaded', self.empty, '--fit',
                                'friction,offset,rotor,base,payload:wrist_3')
        for what, truth in PAYLOAD.items():
            self.assert_near(rows, (what, 'payload of wrist_3'), truth)
        self.assertLess(abs(float(rows['mass', 'payload of wrist_3']['value']) / 2.8 - 1), 0.03)
        # The description is the truth here: base parameters are those that it describes, with its rotors.
        rotors = dict(zip(simulated.JOINTS, TERMS['rotor_inertia']))
        seen = 0
        for (what, of), row in rows.items():
            if of or row['status'] != 'excited':
                continue
            truth = float(row['described']) + sum(
                value for name, value in rotors.items() if 'rotor_inertia of ' + name in what)
            self.assertLess(abs(float(row['value']) - truth), DEVIATIONS * float(row['deviation']), what)
            seen += 1
        self.assertGreater(seen, 20)
        self.assertIn('No motion of this robot shows mass of shoulder', said)
        self.assert_accounted_for(said)
        links = files.Description(self.out('robot.urdf')).root.findall('link')
        for link in links:
            mass = link.find('inertial/mass')
            if mass is not None:
                inertia = link.find('inertial/inertia')
                moments = np.linalg.eigvalsh([[float(inertia.get('i' + ''.join(sorted((a, b)))))
                                               for a in 'xyz'] for b in 'xyz'])
                self.assertGreater(float(mass.get('value')), 0)
                self.assertLessEqual(moments[2], moments[0] + moments[1])

    def test_gains_where_masses_are_known(self):
        gains = np.array([11, 10, 12, 7, 6.5, 7.2])
        path = os.path.join(self.folder, 'current.csv')
        simulated.record(path, self.other, self.empty_efforts / gains, NOISE / gains, 3)
        rows, _ = self.found('--motion', path, '--fit', 'friction,offset,rotor,gain', '--masses-known')
        for name, truth in list(zip(simulated.JOINTS, gains))[:4]:
            self.assert_near(rows, ('gain', name), truth)
        self.assert_near(rows, ('damping', 'joint_3'), TERMS['damping'][2])
        self.assertEqual(rows['gain', 'joint_6']['status'],
                         'not excited: what masses make of the effort is too small')

    def test_friction_by_the_sum_of_two_speeds(self):
        s = np.clip((self.other.qd[:, 3] - self.other.qd[:, 4]) / 0.02, -1, 1)
        coupled = 0.9 * (self.other.qd[:, 3] - self.other.qd[:, 4]) + 1.4 * s * (3 - s * s) / 2
        efforts = self.empty_efforts.copy()
        efforts[:, 3] += coupled
        efforts[:, 4] -= coupled
        path = os.path.join(self.folder, 'coupled.csv')
        simulated.record(path, self.other, efforts, NOISE, 4)
        rows, said = self.found('--motion', path, '--fit', 'friction,offset,rotor,coupled:joint_4-joint_5')
        self.assert_near(rows, ('coupled_damping', 'joint_4-joint_5'), 0.9)
        self.assert_near(rows, ('coupled_coulomb', 'joint_4-joint_5'), 1.4)
        with open(self.out('scene.yaml')) as file:
            self.assertIn('a scene has no key for it', file.read())

    def separate(self, rename):
        """The recording without payload in two files: the motion, and efforts at half of its times."""
        motion = self.changed('motion.csv', lambda header, rows: (header[:7], rows[:, :7]))
        efforts = self.changed('efforts.csv', lambda header, rows: (
            ['time'] + [rename + str(i) for i in range(1, 7)], np.delete(rows, range(1, 7), axis=1)[::2]))
        return motion, efforts

    def test_efforts_of_a_file_of_their_own_with_other_names(self):
        motion, efforts = self.separate('tau')
        rows, _ = self.found('--motion', motion, '--measured', efforts, '--rename', r'tau(\d)=joint_\1', '--fit',
                             'friction,offset,rotor')
        for name, damping, coulomb in list(zip(simulated.JOINTS, TERMS['damping'], TERMS['coulomb']))[:5]:
            self.assert_near(rows, ('damping', name), damping)
            self.assert_near(rows, ('coulomb', name), coulomb)

    def test_the_topic_of_efforts_is_handed_on(self):
        class Asked:
            def measured(self, urdf, scene, motion, efforts, regressor):
                return efforts

        words = self.words(['--motion', self.empty, '--measured', 'm.bag', '--measured-topic', '/torques'])
        study = Study(identify.parser().parse_args(words), [], identify.__file__)
        study.folder, study.tool = self.folder, Asked()
        self.assertEqual(study._measured(None, ['a.csv']), ['--measured', 'm.bag', '--measured-topic', '/torques'])
        self.assertEqual(study._measured(None, ['a.csv'], True), ['--residuals'])
        self.assert_refused('--measured-topic', '--motion', self.empty, '--measured-topic', '/torques')

    # --- one line for what is wrong

    def assert_refused(self, problem, *arguments):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
        self.assertTrue(result.stderr.startswith('identify.py: error: '), result.stderr)
        self.assertIn(problem, result.stderr)
        self.assertFalse(os.path.exists(self.out('scene.yaml')))

    def changed(self, name, change):
        """The recording without payload, of which `change` takes header and rows."""
        with open(self.empty) as file:
            header = file.readline().strip().split(',')
        rows = np.loadtxt(self.empty, delimiter=',', skiprows=1)
        header, rows = change(header, rows)
        path = os.path.join(self.folder, name)
        simulated.write_table(path, header, rows)
        return path

    def test_what_no_recording_tells_is_refused_in_one_line(self):
        bare = self.changed('bare.csv', lambda header, rows: (header[:7], rows[:, :7]))
        self.assert_refused('bare.csv: has no measured efforts: neither columns effort.<joint> nor efforts of joint '
                            'states, and no --measured FILE has them', '--motion', bare)
        self.assert_refused('bare.csv: has no measured efforts', '--motion', self.empty, '--unloaded', bare)
        renamed = self.changed('renamed.csv', lambda header, rows: (
            [name.replace('effort.joint', 'effort.axis') for name in header], rows))
        self.assert_refused('axis_1', '--motion', renamed)
        short = self.changed('short.csv', lambda header, rows: (header, rows[:20]))
        self.assert_refused('too short', '--motion', short)

        def at_rest(header, rows):
            rows[:, 1:7] = rows[0, 1:7]
            return header, rows
        self.assert_refused('the robot rests', '--motion', self.changed('rest.csv', at_rest))

    def test_what_cannot_be_fitted_is_refused_in_one_line(self):
        start = ('--motion', self.empty, '--fit')
        self.assert_refused("'frction' is none of friction", *start, 'frction')
        self.assert_refused('--masses-known', *start, 'gain')
        self.assert_refused('--fit gain: efforts in unknown units', *start, 'gain,base', '--masses-known')
        self.assert_refused('--unloaded', *start, 'base,payload:wrist_3')
        self.assert_refused("no link 'wrist_4'", *start, 'payload:wrist_4')
        self.assert_refused('coupled:joint_4+joint_9', *start, 'coupled:joint_4+joint_9')
        self.assert_refused('nothing.csv', '--motion', 'nothing.csv')
        scene = os.path.join(self.folder, 'scene.yaml')
        pathlib.Path(scene).write_text('jonts: []\n')
        self.assert_refused('jonts', '--motion', self.empty, '--scene', scene)

    def test_a_module_that_is_missing_is_named(self):
        os.mkdir(os.path.join(self.folder, 'scipy'))
        pathlib.Path(self.folder, 'scipy/__init__.py').write_text('raise ImportError()\n')
        result = subprocess.run(
            ['/usr/bin/python3', str(ROOT / 'scripts/identify.py')] + self.words(['--motion', self.empty]),
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
            env=dict(os.environ, PYTHONDONTWRITEBYTECODE='1', PYTHONPATH=self.folder))
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, 'identify.py: error: needs python3-scipy (Debian, Ubuntu: sudo apt '
                         'install python3-scipy)\n')


if __name__ == '__main__':
    unittest.main()
