"""The package's measurements through ROS; scripts/measure_ros.sh builds and calls it.

They print figures and judge nothing: what is to be expected depends on the machine.
"""
import argparse
import datetime
import os
import pathlib
import platform
import statistics
import sys
import time

from ros_session import REAL_TIME, Session, SessionError, handle_signals
from stream_trial import REPOSITORY, StreamTrial, moving_joints, start_copy, start_dynamics

OUTPUT = REPOSITORY / 'output' / 'measure_ros.txt'
REFERENCE_ROBOT = REPOSITORY.parent / 'shared' / 'robots' / 'tiago_no_hand.urdf'
OWN_ROBOT = REPOSITORY / 'urdf' / 'six_axis_arm.urdf'
SHORTEST = 3  # s, of a measurement
FIRST_RATE = 1000  # Hz
LAST_RATE = 64000  # Hz
RATE_STEP = 1.1  # the search ends when rates that hold and that do not are this close
# Later than this after the last joint state, the last record shows that queues had filled.
BEHIND = 0.1  # s


class Report:
    """Lines to standard output and to the file; progress to a terminal's last line only."""

    def __init__(self):
        OUTPUT.parent.mkdir(exist_ok=True)
        self.file = open(OUTPUT, 'w')
        self.progress_shown = False
        self.last_progress = 0.0

    def line(self, text=''):
        self._clear()
        for stream in (sys.stdout, self.file):
            print(text, file=stream, flush=True)

    def progress(self, text):
        if not sys.stderr.isatty():
            # In a log, a sign of life now and then.
            if time.monotonic() - self.last_progress > 10:
                self.last_progress = time.monotonic()
                print('... ' + text, file=sys.stderr, flush=True)
            return
        print('\r\033[K' + text, end='', file=sys.stderr, flush=True)
        self.progress_shown = True

    def _clear(self):
        if self.progress_shown:
            print('\r\033[K', end='', file=sys.stderr, flush=True)
            self.progress_shown = False


def head(report, robot, real_time):
    cpu = next((line.partition(':')[2].strip() for line in open('/proc/cpuinfo')
                if line.startswith('model name')), platform.machine())
    report.line('%s, %d cores, %s, Linux %s' % (
        datetime.datetime.now().strftime('%Y-%m-%d %H:%M'), os.cpu_count(), cpu,
        platform.release()))
    report.line('load average at the start: %.2f (a busy machine spoils the figures)'
                % os.getloadavg()[0])
    report.line('robot: %s, %d coordinates' % (robot.name, len(moving_joints(robot))))
    report.line('scheduling of the measured nodes: %s' % (
        ' '.join(REAL_TIME) if real_time else 'ordinary'))


def measure_latency(report, arguments):
    report.line()
    report.line('Latency from publishing a joint state to receiving the result, %g s, %g Hz to '
                'each node in turn' % (arguments.seconds, arguments.rate))
    with Session(arguments.real_time) as session:
        start_dynamics(session, arguments.programs, arguments.robot,
                       '/latency_probe/to_inverse_dynamics')
        start_copy(session, arguments.programs, '/latency_probe/to_copy')
        probe = session.start('latency_probe', [
            arguments.programs / 'latency_probe', '_robot:=%s' % arguments.robot,
            '_rate:=%g' % arguments.rate, '_seconds:=%g' % arguments.seconds], measured=True)
        begin = time.monotonic()
        while probe.running():
            session.check(may_end=probe)
            report.progress('latency: %.0f of about %.0f s' % (
                time.monotonic() - begin, 2 * arguments.seconds))
            time.sleep(0.2)
        if probe.popen.returncode != 0:
            raise SessionError('latency_probe has failed: %s' % probe.output().strip())
        report.line(probe.output().rstrip())


def print_topics(report, trial):
    heading = '%-44s %9s %9s %9s %9s %9s %9s'
    report.line(heading % ('', '', 'sent to', 'dropped', 'in the', 'gaps in', 'wrong'))
    report.line(heading % ('topic', 'expected', 'recorder', 'there', 'bag', 'seq', 'stamps'))
    for loss in trial.losses:
        report.line('%-44s %9d %9s %9s %9d %9d %9d' % tuple(
            '-' if value is None else value for value in loss))
    report.line('joint states published %d, lost before the node %d, in the node %d; dropped by '
                'it %d, restarts %d' % (
                    trial.joint_states, trial.lost_before_node(), trial.lost_in_node(),
                    trial.run.count('inverse_dynamics', 'dropped'),
                    trial.run.count('inverse_dynamics', 'restarts')))
    report.line('queues of the node: %d messages of each input, %d of each output; of rosbag: 100 '
                'of each topic' % (trial.queues['input'], trial.queues['output']))
    report.line('bag: %.0f MB, its last record %.3f s after the last joint state was due'
                % (trial.run.size_mb, trial.behind()))


def print_late(report, trial):
    for node, received in (('inverse_dynamics', 'samples computed'),
                           ('copy', 'joint states received')):
        late, count = trial.run.count(node, 'late outputs'), trial.run.count(node, received)
        report.line('%-44s %9d of %d (%.4f %%)' % (
            'publish - receipt > 1 ms, ' + node, late, count, 100 * late / max(count, 1)))


def print_run_times(report, trial):
    times = [trial.run.times('inverse_dynamics', 'run time per sample, %s (us)' % kind)
             for kind in ('median', 'p99', 'worst')]
    if all(times):
        report.line('%-44s %9.2f %9.2f %9.2f' % (
            'run time per sample (us): median, p99, worst', statistics.median(times[0]),
            statistics.median(times[1]), max(times[2])))


def print_usage(report, trial):
    report.line('%-44s %9s %9s %9s %12s' % ('process', 'CPU (%)', 'RSS (MB)', 'end (MB)',
                                            'growth (MB)'))
    for name, share, begin, end in trial.usage.table():
        report.line('%-44s %9.1f %9.1f %9.1f %12.2f' % (name, 100 * share, begin, end, end - begin))
    busy, stolen = trial.usage.machine()
    report.line('%-44s %9.1f   (100: one core); stolen by the host %.1f'
                % ('whole machine', 100 * busy, 100 * stolen))


def measure_endurance(report, arguments):
    report.line()
    report.line('Endurance: %g s at %g Hz, all outputs subscribed and recorded, copy_node beside'
                % (arguments.seconds, arguments.rate))
    with Session(arguments.real_time) as session:
        trial = StreamTrial(session, arguments.programs, arguments.robot, arguments.rate,
                            arguments.seconds, True, report.progress)
    print_topics(report, trial)
    print_late(report, trial)
    print_run_times(report, trial)
    print_usage(report, trial)


class RateSearch:
    """Trials at different rates, none of them twice."""

    def __init__(self, report, arguments):
        self.report = report
        self.arguments = arguments
        self.trials = {}

    def node_holds(self, rate):
        """Whether every joint state gave its results, and these left the node."""
        trial = self.trial(rate)
        return trial.lost_before_node() == 0 and trial.lost_in_node() == 0

    def all_holds(self, rate):
        """Whether everything is in the bag, and no queue fills that only puts a loss off."""
        trial = self.trial(rate)
        return self.node_holds(rate) and trial.missing() == 0 and trial.behind() < BEHIND

    def trial(self, rate):
        if rate not in self.trials:
            with Session(self.arguments.real_time) as session:
                self.trials[rate] = StreamTrial(
                    session, self.arguments.programs, self.arguments.robot, rate,
                    self.arguments.seconds, False, self.report.progress)
            self.print_row(self.trials[rate])
        return self.trials[rate]

    def print_row(self, trial):
        dropped = sum(loss.recorder_dropped or 0 for loss in trial.losses)
        shares = {name: 100 * share for name, share, _, _ in trial.usage.table()}
        self.report.line('%9d %9d %10d %10d %10d %10d %10.3f %8.0f %8.0f %8.0f' % (
            trial.rate, trial.joint_states, trial.lost_before_node(), trial.lost_in_node(), dropped,
            trial.missing(), trial.behind(), shares['source'], shares['inverse_dynamics'],
            shares['recorder']))

    def highest(self, condition):
        """The highest rate that holds, by doubling and then halving the interval."""
        good, bad, rate = 0, None, FIRST_RATE
        while rate <= LAST_RATE and bad is None:
            if condition(rate):
                good, rate = rate, 2 * rate
            else:
                bad = rate
        while bad is not None and good and bad > RATE_STEP * good:
            middle = int(round((good + bad) / 2, -2))
            if condition(middle):
                good = middle
            else:
                bad = middle
        if not good:
            return 'below %d Hz' % FIRST_RATE
        return '%d Hz%s' % (good, '' if bad else ' or more')


def measure_highest_rate(report, arguments):
    report.line()
    report.line('Highest rate at which nothing is lost, %g s each, all outputs subscribed and '
                'recorded' % arguments.seconds)
    report.line('%9s %9s %10s %10s %10s %10s %10s %26s' % (
        '', '', 'before', 'in', 'by', 'missing or', 'last', 'CPU (%)        '))
    report.line('%9s %9s %10s %10s %10s %10s %10s %8s %8s %8s' % (
        'rate (Hz)', 'sent', 'the node', 'the node', 'recorder', 'wrong', 'after (s)', 'source',
        'node', 'recorder'))
    search = RateSearch(report, arguments)
    all_holds = search.highest(search.all_holds)
    node_holds = search.highest(search.node_holds)
    report.line('highest rate at which nothing is lost, recorder included: %s' % all_holds)
    report.line('highest rate at which the node loses nothing, while the recorder may: %s'
                % node_holds)


MEASUREMENTS = {'latency': (measure_latency, 20, 1000), 'endurance': (measure_endurance, 60, 1000),
                'highest-rate': (measure_highest_rate, 5, None)}


def parse(words):
    parser = argparse.ArgumentParser(prog='measure_ros.sh', description=__doc__)
    parser.add_argument('--latency', nargs='*', type=float, metavar=('SECONDS', 'RATE'),
                        help='input to ~effort beside copy_node (20 s, 1000 Hz)')
    parser.add_argument('--endurance', nargs='*', type=float, metavar=('SECONDS', 'RATE'),
                        help='all outputs recorded, nothing lost? (60 s, 1000 Hz)')
    parser.add_argument('--highest-rate', nargs='*', type=float, metavar='SECONDS',
                        help='at which nothing is lost, SECONDS for each rate (5)')
    parser.add_argument('--robot', type=pathlib.Path, help='URDF (TIAGo of the reference data if '
                        'that is there, else urdf/six_axis_arm.urdf)')
    parser.add_argument('--programs', type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument('--real-time', action='store_true', help='run the measured nodes with '
                        'real-time priority (%s)' % ' '.join(REAL_TIME))
    arguments = parser.parse_args(words)
    if arguments.robot is None:
        arguments.robot = REFERENCE_ROBOT if REFERENCE_ROBOT.exists() else OWN_ROBOT
    arguments.robot = arguments.robot.resolve()
    given = {name: getattr(arguments, name.replace('-', '_')) for name in MEASUREMENTS}
    if all(values is None for values in given.values()):
        given = {name: [] for name in MEASUREMENTS}
    chosen = []
    for name, (measure, seconds, rate) in MEASUREMENTS.items():
        if given[name] is None:
            continue
        most = 1 if rate is None else 2
        if len(given[name]) > most or not all(value > 0 for value in given[name]):
            parser.error('--%s: expected up to %d positive numbers' % (name, most))
        values = given[name] + [seconds, rate][len(given[name]):]
        if values[0] < SHORTEST:
            parser.error('--%s: expected %g s or more, got %g' % (name, SHORTEST, values[0]))
        chosen.append((measure, argparse.Namespace(
            robot=arguments.robot, programs=arguments.programs, real_time=arguments.real_time,
            seconds=values[0], rate=values[1])))
    return arguments, chosen


def main(words):
    common, chosen = parse(words)
    handle_signals()
    report = Report()
    try:
        head(report, common.robot, common.real_time)
        for measure, arguments in chosen:
            measure(report, arguments)
    except KeyboardInterrupt:
        report.line('interrupted')
        return 130
    except (OSError, SessionError) as problem:
        report.line('measure_ros.sh: %s' % problem)
        return 1
    print('\nThis is also in %s' % OUTPUT.relative_to(REPOSITORY))
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
