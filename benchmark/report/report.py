"""Makes report.md and its plots from what the benchmark programs measured, for scripts/report.sh.

FOLDER holds work_precision.csv, closed_loops.csv and leave_out.csv; instructions.csv if
instructions were counted, generated_size.csv if generated code was measured, estimator.md if the estimator was measured.
"""
import concurrent.futures
import datetime
import os
import pathlib
import sys

import comparisons
import machine
import markdown_text as md
import report_pages as pages
from page_program import progress, run
from plot_joints import plot_joints
from plot_leave_out import plot_leave_out
from plot_work_precision import plot_work_precision
from report_data import (CLOSED_LOOPS, GENERATED_SIZES, INSTRUCTIONS, LEAVE_OUT, WORK_PRECISION,
                         ClosedLoops, GeneratedSizes, Instructions, JointCounts, LeaveOut,
                         WorkPrecision)

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent.parent
REPORT = 'report.md'
ESTIMATOR = 'estimator.md'
JOINTS_PLOT = 'joints.png'
LEAVE_OUT_PLOT = 'leave_out.png'
TEXT = pathlib.Path(__file__).resolve().parent / 'report_template.md'

QUICK = ('\n**This is a quick run** (`--quick`): few and short rounds, so times scatter more than '
         'in a full one.\n')


def scene_plot(scene):
    return 'work_precision_%s.png' % scene


def estimator_section(folder):
    if not (folder / ESTIMATOR).is_file():
        return 'The estimator was not measured in this run.\n'
    return ('Accelerations from joint states have a page of their own: '
            '[error of the estimator against window and lag](%s).\n' % ESTIMATOR)


def instructions_section(folder, data):
    if not (folder / INSTRUCTIONS).is_file():
        return 'They were not counted in this run: a quick one does not, and it takes valgrind.\n'
    return ('Counted by callgrind, which runs the program on a simulated processor; unlike times, '
            'they do\nnot depend on what else the machine does. It knows no AVX-512.\n\n'
            + pages.instructions_table(Instructions(folder / INSTRUCTIONS), data))


def generated_section(folder):
    if not (folder / GENERATED_SIZES).is_file():
        return 'It was not measured in this run.\n'
    return pages.generated_sizes_table(GeneratedSizes(folder / GENERATED_SIZES))


def leave_out_tables(omissions):
    return '\n'.join('**%s**\n\n%s' % (pages.scene_title(scene),
                                       pages.leave_out_table(omissions, scene))
                     for scene in omissions.scenes)


def text(folder, data, omissions, joints, build, arguments):
    libraries = [[name, version or '**not found**'] for name, version in machine.libraries(build)]
    return TEXT.read_text(encoding='utf-8').format(
        date=datetime.datetime.now().strftime('%Y-%m-%d %H:%M'),
        quick=QUICK if arguments.quick else '',
        short=pages.short_version(data, joints),
        machine=md.table(['', ''], machine.facts(build, REPOSITORY, arguments.load), left=2),
        libraries=md.table(['library', 'version'], libraries, left=2),
        scenes=pages.scenes_table(data, joints),
        not_measured=pages.not_measured(data),
        ratios=pages.ratios_table(data),
        against_peers=pages.comparisons_table(comparisons.peer_comparisons(data)),
        own_ways=pages.comparisons_table(comparisons.own_comparisons(data)),
        same='%.0f' % (100 * comparisons.SAME),
        did_not_win=pages.did_not_win(data),
        errors=pages.errors_table(data),
        plots='\n'.join('### %s\n\n%s' % (pages.scene_title(scene), md.image(
            'Error over run time: ' + pages.scene_title(scene), scene_plot(scene)))
                        for scene in data.scenes),
        joints_plot=md.image('Run time over number of joints', JOINTS_PLOT),
        joint_costs=pages.joint_costs_table(data, joints),
        instructions=instructions_section(folder, data),
        generated=generated_section(folder),
        leave_out_plot=md.image('Operations and run time of plans that leave something out',
                                LEAVE_OUT_PLOT),
        leave_out=leave_out_tables(omissions),
        estimator=estimator_section(folder),
        dash=md.NONE,
        spread=pages.spread(data),
        tables='\n'.join(md.folded(pages.scene_title(scene), pages.full_table(data, scene))
                         for scene in data.scenes))


def write(folder, arguments):
    loops = ClosedLoops(folder / CLOSED_LOOPS)  # they have a page of their own
    data = WorkPrecision(folder / WORK_PRECISION).of_scenes(
        lambda scene: scene not in loops.counts)
    omissions = LeaveOut(folder / LEAVE_OUT)
    build = machine.Build(arguments.build)
    shared = build.value('VWD_SHARED_DATA') or REPOSITORY.parent / 'shared'
    counts = JointCounts([REPOSITORY / 'urdf', REPOSITORY / 'benchmark' / 'contenders',
                          pathlib.Path(shared) / 'robots'])
    joints = {scene: counts.of(scene) for scene in data.scenes if counts.of(scene)}
    progress('plots of error over run time')
    with concurrent.futures.ProcessPoolExecutor() as pool:
        list(pool.map(plot_work_precision, [data] * len(data.scenes), data.scenes,
                      map(pages.scene_title, data.scenes),
                      [folder / scene_plot(scene) for scene in data.scenes]))
    progress('plots of joints and omissions')
    if joints:
        plot_joints(data, joints, folder / JOINTS_PLOT)
    plot_leave_out(omissions, pages.scene_title, folder / LEAVE_OUT_PLOT)
    (folder / REPORT).write_text(text(folder, data, omissions, joints, build, arguments),
                                 encoding='utf-8')
    progress(None)


def add_options(parser):
    parser.add_argument('--quick', action='store_true', help='say that the run was a quick one')
    parser.add_argument('--load', metavar='AVERAGE', help='load average before the measurements')
    parser.add_argument('--build', type=pathlib.Path, default=REPOSITORY / 'build' / 'benchmark',
                        help='where the programs were built (build/benchmark)')


def write_and_say(arguments):
    write(arguments.folder, arguments)
    print('Report: %s' % os.path.relpath(str(arguments.folder / REPORT)))


if __name__ == '__main__':
    sys.exit(run('report.py', __doc__, write_and_say, add_options))
