"""Robots and parameters that inverse_dynamics_node refuses to start on, and what the line says."""
import re

# About the centre of mass; parts of a robot description.
INERTIAL = ('<inertial><origin xyz="0.1 0 0"/><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" '
            'iyy="0.1" iyz="0" izz="0.1"/></inertial>')
AXIS = '<axis xyz="0 0 1"/>'


def joint(name, parent, child, kind='continuous', inside=AXIS):
    return ('<joint name="%s" type="%s"><parent link="%s"/><child link="%s"/>%s</joint>'
            % (name, kind, parent, child, inside))


def robot(*joints, inertial=INERTIAL, links='base arm hand'):
    """A chain of links, all with the same inertial."""
    text = ''.join('<link name="%s">%s</link>' % (link, inertial if link != 'base' else '')
                   for link in links.split())
    return '<robot name="tester">%s%s</robot>' % (text, ''.join(joints))


HINGE = joint('hinge', 'base', 'arm')
WRIST = joint('wrist', 'arm', 'hand')
GOOD = robot(HINGE, WRIST)


def with_inertial(**changes):
    """GOOD, except for attributes of the inertial of both links."""
    inertial = INERTIAL
    for attribute, value in changes.items():
        name = 'value' if attribute == 'mass' else attribute
        inertial = re.sub(name + '="[^"]*"', '%s="%s"' % (name, value), inertial)
    return robot(HINGE, WRIST, inertial=inertial)


def mimic(master):
    return AXIS + '<mimic joint="%s"/>' % master


# Robots: what is wrong, the description, and parts of the FATAL line.
BAD_ROBOTS = {
    'no_robot_description': (None, ['robot_description: not set']),
    'robot_description_that_is_no_text': (7, ['robot_description', 'expected the text of a URDF']),
    'empty_robot_description': (' \n', ['robot_description', 'empty']),
    'broken_xml': ('<robot name="tester"><link name="base"></robot>',
                   ['robot_description', 'broken']),
    'no_xml_at_all': ('tester.urdf', ['robot_description', 'broken']),
    'two_roots': (robot(HINGE), ['robot_description', "links 'base' and 'hand' are all roots"]),
    'joint_to_unknown_link': (robot(HINGE, joint('wrist', 'arm', 'paw')), ['paw']),
    'negative_mass': (with_inertial(mass='-2'), ["link 'arm'", 'mass -2']),
    'mass_nan': (with_inertial(mass='nan'), ['arm', 'mass']),
    'mass_infinite': (with_inertial(mass='1e999'), ['arm', 'mass']),
    'mass_that_is_no_number': (with_inertial(mass='heavy'), ['arm', 'mass']),
    'inertia_nan': (with_inertial(iyy='nan'), ['arm', 'inertia']),
    'inertia_infinite': (with_inertial(izz='inf'), ['arm', 'inertia']),
    'zero_axis': (robot(HINGE, joint('wrist', 'arm', 'hand', inside='<axis xyz="0 0 0"/>')),
                  ["joint 'wrist'", 'axis (0, 0, 0)']),
    'mimic_cycle': (robot(joint('hinge', 'base', 'arm', inside=mimic('wrist')),
                          joint('wrist', 'arm', 'hand', inside=mimic('hinge'))),
                    ["joint 'hinge'", 'cycle']),
    'mimic_of_itself': (robot(HINGE, joint('wrist', 'arm', 'hand', inside=mimic('wrist'))),
                        ["joint 'wrist'", 'cycle']),
    'mimic_misspelt': (robot(HINGE, joint('wrist', 'arm', 'hand', inside=mimic('hnge'))),
                       ["joint 'wrist'", "'hnge'; did you mean 'hinge'?"]),
    'xacro': ('<robot xmlns:xacro="http://wiki.ros.org/xacro"><xacro:macro name="arm"/></robot>',
              ['parameter ', 'robot_description: this is a xacro file', 'rosrun xacro xacro FILE']),
    'spherical_joint_among_capsules': (
        robot(HINGE, joint('wrist', 'arm', 'hand', 'spherical'), inertial=INERTIAL +
              '<visual><geometry><capsule radius="1"/></geometry></visual>'),
        ["robot_description: joint 'wrist': type 'spherical' is not one of"]),
    'control_characters': (robot(HINGE, joint('wr&#10;ist&#x1b;[31m', 'arm', 'hand', 'flying')),
                           [r"joint 'wr\nist\x1b[31m': type 'flying' is not one of"]),
    'mimic_of_unknown_joint': (robot(HINGE, joint('wrist', 'arm', 'hand', inside=mimic('knee'))),
                               ["joint 'wrist'", "'knee'"]),
    'joint_named_ground': (robot(joint('ground', 'base', 'arm'), WRIST), ["joint 'ground'"]),
    'colliding_topic_names': (robot(joint('a-b', 'base', 'arm'), joint('a.b', 'arm', 'hand')),
                              ["'a-b'", "'a.b'", '~reaction/a_b']),
    'nothing_that_moves': (robot(joint('weld', 'base', 'arm', 'fixed'),
                                 joint('glue', 'arm', 'hand', 'fixed')),
                           ["robot 'tester'", 'no joint that moves']),
}

STRICT = {'scene': {'strict_inertia': True}}
# Robots that are computed with a warning of the link, unless strict_inertia refuses them.
DOUBTFUL = {
    'negative_moment': (with_inertial(ixx='-0.05'), ["link 'arm'", "link 'hand'"], '-0.05'),
    'triangle': (with_inertial(ixx='0.3'), ["link 'arm'", "link 'hand'"], '0.3'),
    'massless_moving_leaf': (robot(HINGE, WRIST, links='base arm').replace(
        '</robot>', '<link name="hand"/></robot>'), ["link 'hand'"], '0 kg'),
}


def loop(actuated=None, **changes):
    """A scene that joins the ends of the good robot once more."""
    closure = dict({'name': 'pin', 'type': 'revolute', 'parent': {'link': 'base'},
                    'child': {'link': 'hand'}}, **changes)
    scene = {'closures': [closure]}
    return {'scene': dict(scene, actuated=actuated) if actuated else scene}


# What replaces parameters that no longer exist, as the line that refuses them says.
NEW_ONES = ['no longer exists', '~estimator/position_noise', 'velocity_noise', 'stamp_noise',
            'bandwidth', '~estimator/lag is in seconds']
# Parameters of a good robot, and parts of the FATAL line.
BAD_PARAMETERS = {
    'unknown_joint_in_reactions': ({'scene': {'reactions': ['hinge', 'knee']}}, [
        "parameter ~scene: reactions[1]: no joint 'knee'; known are 'hinge' and 'wrist'"]),
    'joint_twice_in_reactions': ({'scene': {'reactions': ['hinge', 'hinge']}}, ["'hinge'"]),
    'unknown_link_in_applied_wrenches': (
        {'scene': {'applied_wrenches': [{'link': 'paw', 'force': [0, 0, 1]}]}}, ["'paw'"]),
    'unknown_key_in_applied_wrenches': (
        {'scene': {'applied_wrenches': [{'link': 'arm', 'forse': [0, 0, 1]}]}},
        ["parameter ~scene: applied_wrenches[0].forse: unknown key; did you mean 'force'?"]),
    'unknown_scene_key': ({'scene': {'gravitation': [0, 0, 1]}},
                          ['parameter ~scene: gravitation: unknown key']),
    'root_that_moves': ({'scene': {'root': 'moving'}}, [
        'root: moving: ~root/source does not say who tells how the root link moves']),
    'source_of_a_root_that_rests': ({'root': {'source': 'tf'}}, [
        "parameter ~root/source: the scene does not say 'root: moving'"]),
    'source_that_is_unknown': ({'root': {'source': 'gps'}}, [
        "parameter ~root/source: 'gps' is none of odometry, trajectory, states, tf and imu"]),
    'imu_and_gravity': ({'root': {'source': 'imu'}, 'scene': {
        'root': 'moving', 'gravity': [0, 0, -9.81]}}, [
            'gravity: with ~root/source: imu it is measured, and is not given']),
    'imu_of_a_static_scene': ({'root': {'source': 'imu'}, 'scene': {
        'root': 'moving', 'motion': 'static'}}, [
            'motion: static: with ~root/source: imu the attitude is not known']),
    'imu_without_estimates': ({'root': {'source': 'imu'}, 'scene': {'root': 'moving'},
                               'estimator': {'acceleration': 'zero'}}, [
                                   'parameter ~estimator/acceleration: zero: with']),
    'timeout_of_the_root': ({'root': {'timeout': 0}}, ['parameter ~root/timeout: 0 s']),
    'gravity_of_two': ({'scene': {'gravity': [0, 1]}}, ['gravity', 'three numbers']),
    'gravity_that_is_no_number': ({'scene': {'gravity': [0, 0, 'down']}}, ['gravity', "'down'"]),
    'closure_without_a_type': ({'scene': {'closures': [{'name': 'pin'}]}},
                               ['closures[0]: type is missing']),
    'closure_of_an_unknown_type': ({'scene': {'closures': [{'type': 'hinge'}]}},
                                   ['closures[0].type', "'hinge'"]),
    'spring_without_stiffness': (
        {'scene': {'springs': [{'name': 's', 'link_a': 'arm', 'link_b': 'hand'}]}},
        ['springs[0]: stiffness is missing']),
    'actuated_that_is_no_list': ({'scene': {'actuated': 'hinge'}}, ['actuated: expected a list']),
    'assembly_that_is_a_map': ({'scene': {'assembly': {'hinge': 1}}},
                               ['assembly: expected a list']),
    'policy_of_another_kind': ({'scene': {'redundancy': {'policy': 'least'}}},
                               ['redundancy.policy', "'least'"]),
    'scene_that_is_no_map': ({'scene': 5}, ['parameter ~scene: expected a map of keys']),
    'scene_that_is_the_name_of_a_file': ({'scene': 'scene.yaml'}, [
        "parameter ~scene: expected a map of keys, got the text 'scene.yaml'"]),
    'scene_as_text_that_is_cut': ({'scene': '{gravity: [0, 0'}, ['parameter ~scene: is not valid']),
    'unknown_parameter': ({'twists': True}, ['unknown parameter ~twists (did you mean ~twist?)']),
    'unknown_nested_parameter': ({'estimator': {'windows': 9}},
                                 ['unknown parameter ~estimator/windows; known are ']),
    'number_that_is_text': ({'estimator': {'max_gap': 'long'}}, ['~estimator/max_gap', "'long'"]),
    'integer_that_is_none': ({'queue_size': {'input': 9.5}}, ['~queue_size/input', '9.5']),
    'boolean_that_is_a_number': ({'twist': 1}, ['~twist', 'true or false']),
    'text_that_is_a_number': ({'frame_prefix': 3}, ['~frame_prefix', 'expected text']),
    'group_that_is_a_number': ({'estimator': 3}, ['~estimator']),
    'acceleration_of_another_kind': ({'estimator': {'acceleration': 'guess'}},
                                     ['~estimator/acceleration', "'guess'"]),
    'window_of_the_old_estimator': ({'estimator': {'window': 9}}, ['~estimator/window'] + NEW_ONES),
    'order_of_the_old_estimator': ({'estimator': {'order': 3}}, ['~estimator/order'] + NEW_ONES),
    'lag_in_samples': ({'estimator': {'lag': 4}}, ['~estimator', 'lag is 4', 'from 0 to 1 s']),
    'negative_lag': ({'estimator': {'lag': -0.1}}, ['~estimator', 'lag is -0.1', 'from 0 to 1 s']),
    'lag_nan': ({'estimator': {'lag': float('nan')}}, ['~estimator']),
    'noise_of_nothing': ({'estimator': {'position_noise': 0}},
                         ['~estimator/position_noise: 0 is neither auto nor positive']),
    'negative_velocity_noise': ({'estimator': {'velocity_noise': -1}},
                                ['~estimator/velocity_noise: -1 is neither auto nor positive']),
    'negative_stamp_noise': ({'estimator': {'stamp_noise': -1.0}}, [
        '~estimator/stamp_noise: -1 is neither auto nor zero or positive']),
    'bandwidth_that_is_text': ({'estimator': {'bandwidth': 'wide'}},
                               ['parameter ~estimator/bandwidth', "'wide'"]),
    'infinite_bandwidth': ({'estimator': {'bandwidth': float('inf')}}, ['~estimator/bandwidth']),
    'hold_after_nothing': ({'hold_after': 0}, ['parameter ~hold_after: 0 s is not positive']),
    'rest_that_is_a_map': ({'rest': {'hinge': 1}}, ['~rest', '[{name: finger, position: 0.02}]']),
    'rest_without_a_position': ({'rest': [{'name': 'hinge'}]},
                                ['~rest', '[{name: finger, position: 0.02}]']),
    'rest_of_an_unknown_joint': ({'rest': [{'name': 'knee', 'position': 1}]},
                                 ['~rest', "'tester' has no joint 'knee'"]),
    'rest_that_is_text': ({'rest': [{'name': 'hinge', 'position': 'closed'}]},
                          ["parameter ~rest of 'hinge'", "'closed'"]),
    'threshold_of_an_unknown_joint': (
        {'external_effort': {'thresholds': [{'name': 'knee', 'effort': 1}]}},
        ["parameter ~external_effort/thresholds: robot 'tester' has no joint 'knee'"]),
    'threshold_of_nothing': ({'external_effort': {'thresholds': [{'name': 'hinge', 'effort': 0}]}},
                             ["parameter ~external_effort/thresholds: 'hinge': 0 is not positive"]),
    'threshold_of_a_joint_without_an_actuator': (
        {'external_effort': {'thresholds': [{'name': 'wrist', 'effort': 1}]},
         'scene': {'actuated': ['hinge'], 'free_motion': True}},
        ["parameter ~external_effort/thresholds: 'wrist' is passive"]),
    'effort_limits_of_a_description_without_any': (
        {'effort_limit_warn': True},
        ["parameter ~effort_limit_warn: robot 'tester' has no actuated joint with a limit"]),
    'thresholds_that_are_a_map': ({'external_effort': {'thresholds': {'hinge': 1}}},
                                  ['~external_effort/thresholds: expected a list like']),
    'observer_of_a_static_scene': (
        {'external_effort': {'by': 'observer'}, 'scene': {'motion': 'static'}},
        ['parameter ~external_effort/by: observer: momentum observer: a static scene']),
    'observer_gain_of_nothing': ({'external_effort': {'gain': 0}},
                                 ['parameter ~external_effort/gain: 0 1/s is not positive']),
    'negative_trajectory_rate': ({'trajectory_rate': -1}, ['~trajectory_rate: -1 points/s']),
    'trajectory_rate_too_high': ({'trajectory_rate': 1e6}, ['~trajectory_rate: ', 'to 20000']),
    'negative_trajectory_sampling': ({'trajectory_sampling': -1},
                                     ['~trajectory_sampling: -1 Hz is neither 0 nor from 0.001']),
    'trajectory_sampling_too_high': ({'trajectory_sampling': 1e6},
                                     ['~trajectory_sampling: ', 'to 1e+05']),
    'trajectory_sampling_nan': ({'trajectory_sampling': float('nan')}, ['~trajectory_sampling']),
    'negative_cross_check_rate': ({'cross_check_rate': -1}, ['~cross_check_rate: -1 checks/s']),
    'cross_check_rate_too_high': ({'cross_check_rate': 1001},
                                  ['~cross_check_rate: 1001 checks/s', 'to 1000']),
    'cross_check_rate_of_ages': ({'cross_check_rate': 1e-11},
                                 ['~cross_check_rate: 1e-11 checks/s', 'from 0.001']),
    'certificates_that_are_a_number': ({'certificates': 1}, ['~certificates', 'true or false']),
    'warning_at_nothing': ({'residual_warn': 0}, ['~residual_warn: 0 is not positive']),
    'warning_that_is_text': ({'residual_warn': 'small'}, ['~residual_warn', "'small'"]),
    'error_before_the_warning': ({'residual_warn': 1e-6},
                                 ['~residual_error: 1e-07 is less than ~residual_warn = 1e-06']),
    'doubt_of_everything': ({'deviation_warn': 0}, ['~deviation_warn: 0 is not positive']),
    'tolerance_of_all': ({'scene': {'tolerances': {'mass': 1}}},
                         ['mass', '1 is not from 0 to below 1']),
    'negative_gap': ({'estimator': {'max_gap': -0.1}},
                     ['parameter ~estimator/max_gap: -0.1 s is not positive']),
    'queue_of_nothing': ({'queue_size': {'output': 0}}, ['~queue_size/output', '0']),
    'endless_queue_by_a_negative_size': ({'queue_size': {'input': -1}},
                                         ['~queue_size/input', '-1']),
    'loop_tolerance_of_nothing': ({'loop_tolerance': 0}, ['~loop_tolerance: 0 is not positive']),
    'condition_of_less_than_one': ({'condition_warn': 0.5}, ['~condition_warn: 0.5 is not greater']),
    'closure_on_an_unknown_link': (loop(child={'link': 'paw'}), ["'pin'", "'paw'"]),
    'closure_named_like_a_joint': (loop(name='hinge'), ["'hinge'"]),
    'closure_named_like_a_link': (loop(name='arm'), ["closures: 'arm' is also the name of a link"]),
    'closure_that_cannot_be_assembled': (loop(parent={'link': 'base', 'xyz': [1, 0, 0]}),
                                         ["'pin' cannot be assembled", 'open by 1 m']),
    'actuated_joints_too_few': ({'scene': {'actuated': ['hinge']}}, ["'wrist'"]),
    'actuated_joint_that_is_unknown': (loop(actuated=['knee']), ["'knee'"]),
    'period_zero': ({'diagnostic_period': 0}, ['~diagnostic_period', '0 s']),
    'negative_threshold': ({'late_threshold': -1.0}, ['~late_threshold', '-1 s']),
}
