#!/usr/bin/python3
"""What the launch files read robots and scenes with: xacro, bad files, scenes as they are meant."""
import os
import shutil
import subprocess

import yaml

from launches import ARM, LaunchTest
from node_under_test import executable, run, wait_until


class LaunchInputs(LaunchTest):
    # --- xacro

    def read_input(self, kind, path, **environment):
        return subprocess.run([executable('read_input.py'), kind, path], cwd=self.folder, check=False,
                              env=dict(self.environment, **environment), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, encoding='utf-8')

    def test_xacro_in_path(self):
        self.program('bin/xacro', 'echo "xacro: a warning" >&2; sed s/ARM/test_arm/ "$1"\n')
        self.environment['PATH'] += ':' + os.path.join(self.folder, 'bin')
        name = self.write('the robot\'s "r".urdf.xacro', ARM.replace('name="test_arm"', 'name="ARM"'))
        result = self.read_input('robot', name)
        self.assertEqual((result.returncode, result.stdout, result.stderr),
                         (0, ARM, 'xacro: a warning\n'))
        launch = self.inverse_dynamics('robot:=' + name, namespace='expanded')
        wait_until(lambda: "Robot 'test_arm' from /expanded/robot_description" in launch.output(),
                   launch.output)
        # A name that begins with a dash is not taken for an option.
        self.assertEqual(self.read_input('robot', self.write('-v.xacro', ARM)).stdout, ARM)

    def test_xacro_as_a_package(self):
        if shutil.which('xacro'):
            self.skipTest('xacro is installed')
        self.package('xacro', 'xacro', 'cat "$1"\n')
        result = self.read_input('robot', self.write('robot.xacro', ARM))
        self.assertEqual((result.returncode, result.stdout), (0, ARM), result.stderr)

    def test_without_xacro_one_line_says_how(self):
        empty = os.path.join(self.folder, 'empty')
        result = self.read_input('robot', self.write('the robot\'s "r".urdf.xacro', ARM), PATH=empty)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
        for part in ('robot:=the robot\'s "r".urdf.xacro: needs xacro, which is not installed',
                     'sudo apt install ros-noetic-xacro',
                     'xacro \'the robot\'"\'"\'s "r".urdf.xacro\' > robot.urdf'):
            self.assertIn(part, result.stderr)

    def test_what_xacro_says_is_one_line(self):
        self.program('bin/xacro', 'printf "undefined name\\n\\n  in file\\n" >&2; exit 2\n')
        self.environment['PATH'] += ':' + os.path.join(self.folder, 'bin')
        result = self.read_input('robot', self.write('robot.xacro', ARM))
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr,
                         'robot:=robot.xacro: xacro cannot expand it: undefined name; in file\n')

    def test_files_that_are_no_description(self):
        with open(os.path.join(self.folder, 'latin.urdf'), 'wb') as file:
            file.write('<robot name="B\xe4r"/>'.encode('latin-1'))
        for path, problem in (('latin.urdf', 'is not text in UTF-8'),
                              ('/dev/zero', 'never ends, or is longer than any input'),
                              ('.', 'Is a directory'), ('no.xacro', 'No such file or directory')):
            result = self.read_input('robot', path)
            self.assertEqual((result.returncode, result.stderr),
                             (1, 'robot:=%s: %s\n' % (path, problem)))

    # --- scenes

    def test_scenes_are_read_as_the_offline_tool_reads_them(self):
        name = self.write('scene.yaml', """
# Words that YAML 1.1 takes for booleans and numbers.
reactions: [on, no, 007, 7, "7", 1_0, 1:30, true]
gravity: &down [0, -1.5, 1e-3]
applied_wrenches: [{link: off, force: *down}]
include_active: yes
motion: "static"
closures:
""")
        result = self.read_input('scene', name)
        self.assertEqual(result.returncode, 0, result.stderr)
        # As the node has it, whose texts and numbers are the texts of the file again.
        self.assertEqual(yaml.safe_load(result.stdout), {
            'reactions': ['on', 'no', '007', 7, '7', '1_0', '1:30', True],
            'gravity': [0, -1.5, '1e-3'],
            'applied_wrenches': [{'link': 'off', 'force': [0, -1.5, '1e-3']}],
            'include_active': 'yes', 'motion': 'static', 'closures': ''})
        self.assertEqual(self.read_input('scene', self.write('empty.yaml', '# nothing\n')).stdout, '{}')

    def test_scenes_that_are_refused(self):
        aliases = ''.join('%s: &%s [%s]\n' % (chr(i), chr(i), ', '.join(
            ['*' + chr(i - 1) if i > ord('a') else '1'] * 10)) for i in range(ord('a'), ord('h')))
        for text, problem in (
                (',', 'is not valid YAML: line 1, column 1: '),
                ('gravity: [0, 0', 'is not valid YAML: line '),
                ('gravity: [0, 0, 1]\n\ngravity: [0, 0, 2]\n', 'line 3: gravity: given twice'),
                ('joints:\n  - {name: a, name: b}\n', 'line 2: name: given twice'),
                ('a: &a {b: *a}\n', 'line 1: there is no value *a yet'),
                (aliases, 'line 6: there are more than a million values'),
                ('a: ' + '[' * 100000, 'line 1: is nested more than 64 deep'),
                ('a: 1\n---\nb: 2\n', 'has more than one document'),
                ('gra vity: 1\n', "line 1: 'gra vity': unknown key"),
                ('[a]: 1\n', 'line 1: a key is not a word'), ('- a\n', 'is not a map of keys')):
            result = self.read_input('scene', self.write('scene.yaml', text))
            self.assertEqual(result.returncode, 1, text[:50])
            self.assertEqual(result.stderr.count('\n'), 1, result.stderr)
            self.assertTrue(result.stderr.startswith('scene:=scene.yaml: ' + problem), result.stderr)


if __name__ == '__main__':
    run(LaunchInputs)
