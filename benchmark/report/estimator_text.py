"""Words and tables of the estimator's page, all from the measurements."""
import estimator_data as ed
import markdown_text as md

METHOD_NAMES = {
    ed.DEFAULT: 'the estimator (`completeMotion()`)',
    'local_polynomial': 'local polynomials, window by bias and variance',
    'white_jerk': 'white jerk, noise by likelihood',
    'white_snap': 'white snap, noise by likelihood',
    'white_fifth': 'white fifth derivative, noise by likelihood',
    'spline': 'quintic smoothing spline, cross-validation',
    'nine_samples': 'nine samples, order 3 (the old default)',
}
GROUP_NAMES = {
    ed.GRID: 'grid',
    'uneven': 'truly uneven sampling',
    'white': 'noise of 3 quanta',
    'dropped': '5 % of the rows dropped',
    'fourier': 'slow sines, moving at the start',
    'trapezoids': 'trapezoids of velocity',
    'still': 'two joints stand still',
}
WRONG_NAMES = {'zero': 'always zero', 'degrees': 'in degrees', 'too_large': '20 % too large',
               'noisy': 'noise of 0.3 rad/s'}


def percent(share):
    return '%.0f %%' % (100 * share)


def stream_name(stream):
    words = ['%d Hz' % stream.rate, '%g rad' % stream.quantum]
    if stream.velocities not in ('none',):
        words.append('velocities' if stream.velocities == 'good'
                     else 'velocities ' + WRONG_NAMES[stream.velocities])
    if stream.jitter:
        words.append('jitter %g ms' % stream.jitter)
    if stream.group in GROUP_NAMES and stream.group != ed.GRID:
        words.insert(0, GROUP_NAMES[stream.group])
    return ', '.join(words)


def _median_worst(ratios):
    ratio, stream = ed.worst(ratios)
    return [md.ratio(ed.median(ratios)), md.ratio(ratio), stream_name(stream)]


def _bound(ratios, bound):
    """How many are above a bound, in words."""
    above = ed.beyond(ratios, bound)
    if not above:
        return 'none above %g' % bound
    return '%d of %d above %g' % (len(above), len(ratios), bound)


def offline_line(figures):
    ratios = figures.offline_ratios(ed.DEFAULT, (ed.GRID,))
    return ('Offline, the defaults err %s times (median; worst %s, %s) as much as the best filter '
            'of Savitzky and Golay that hindsight finds for each of %d streams; %s.' % (
                *_median_worst(ratios), len(ratios), _bound(ratios, ed.WORST_BOUND)))


def hard_line(figures):
    ratios = figures.offline_ratios(ed.DEFAULT, ed.HARD)
    return ('On %d streams that fool simple answers: %s times (median; worst %s, %s); %s.' % (
        len(ratios), *_median_worst(ratios), _bound(ratios, ed.HARD_BOUND)))


def old_line(figures):
    ratios = figures.offline_ratios('nine_samples', (ed.GRID,))
    return ('The old default, a polynomial of order 3 over nine samples, erred %s times as much '
            '(median; worst %s, %s).' % tuple(_median_worst(ratios)))


def node_line(figures):
    lag = ed.NODE_LAG
    ratios = figures.node_ratios(lag, (ed.GRID,))
    hard = figures.node_ratios(lag, ed.HARD)
    return ('In the node, at the default lag of %g ms, the error is %s times (median; worst %s, '
            '%s) that of a Kalman smoother of the same lag with the true noises and the best '
            'density of the motion; %s. '
            'On the hard streams: %s times (median; worst %s, %s); %s.' % (
                lag, *_median_worst(ratios), _bound(ratios, ed.NODE_BOUND), *_median_worst(hard),
                _bound(hard, ed.NODE_BOUND)))


def calibration_line(figures):
    parts = []
    for method, name in ((ed.DEFAULT, 'offline'), (ed.NODE, 'node')):
        for quantity in ('acceleration', 'effort'):
            shares = figures.calibration(method, quantity)
            if shares:
                parts.append('%s of the streams (%s, %s)' % (
                    percent(ed.share_calibrated(shares)), name, quantity))
    return '90 to 99 %% of the errors are within two deviations in %s.' % md.listed(parts)


def recording_line(figures):
    found = _recording(figures)
    if not found:
        return 'No real recording was at hand.'
    late = _recording(figures, 'recording_late')
    offline, node = (ed.DEFAULT, ed.OFFLINE_LAG), (ed.NODE, ed.NODE_LAG)
    best = 'butterworth', ed.OFFLINE_LAG
    return ('A real recording: efforts of the defaults explain %.3f of the variance of the '
            'measured torques, those of the best Butterworth filter %.3f; after the first second '
            'the node explains %.3f, the filter %.3f.' % (found[offline], found[best], late[node],
                                                 late[best]))


def short_version(figures):
    lines = [offline_line(figures), hard_line(figures), old_line(figures), node_line(figures),
             calibration_line(figures), recording_line(figures)]
    return '\n'.join('- ' + line for line in lines)


def extent(figures):
    grid = figures.streams('offline', (ed.GRID,))
    return '%d streams: %s Hz; quanta of %s rad; %s; stamps that err by %s ms.' % (
        len(grid), md.listed(str(r) for r in sorted({s.rate for s in grid})),
        md.listed('%g' % q for q in sorted({s.quantum for s in grid})),
        'with and without velocities' if len({s.velocities for s in grid}) > 1
        else 'without velocities',
        md.listed('%g' % j for j in sorted({s.jitter for s in grid})))


def methods_table(figures):
    rows = []
    for method in (ed.DEFAULT,) + ed.CONTENDERS:
        inside = figures.offline_ratios(method, (ed.GRID,))
        hard = figures.offline_ratios(method, ed.HARD)
        ends = figures.offline_ratios(method, (ed.GRID,), 'end_error')
        rows.append([METHOD_NAMES[method]] + [
            md.ratio(value) for ratios in (inside, hard, ends)
            for value in (ed.median(ratios), ed.worst(ratios)[0])])
    return md.table(['', 'grid: median', 'worst', 'hard: median', 'worst', 'ends: median', 'worst'],
                    rows)


def groups_table(figures):
    rows = []
    for group in figures.groups('offline'):
        ratios = figures.offline_ratios(ed.DEFAULT, (group,))
        node = figures.node_ratios(ed.NODE_LAG, (group,))
        ratio, stream = ed.worst(ratios)
        rows.append([GROUP_NAMES.get(group, group), stream_name(stream._replace(group=ed.GRID)),
                     md.ratio(ed.median(ratios)), md.ratio(ratio), md.ratio(ed.median(node)),
                     md.ratio(ed.worst(node)[0])])
    return md.table(['streams', 'worst offline', 'offline: median', 'worst', 'node: median',
                     'worst'], rows, left=2)


def beyond_table(figures):
    """Streams above the bounds."""
    rows = []
    for groups, bound in (((ed.GRID,), ed.WORST_BOUND), (ed.HARD, ed.HARD_BOUND)):
        ratios = figures.offline_ratios(ed.DEFAULT, groups)
        rows += [['offline', stream_name(s), md.ratio(r), '%g' % bound]
                 for s, r in ed.beyond(ratios, bound)]
    for lag in figures.lags():
        ratios = figures.node_ratios(lag, (ed.GRID,) + ed.HARD)
        rows += [['node, %g ms' % lag, stream_name(s), md.ratio(r), '%g' % ed.NODE_BOUND]
                 for s, r in ed.beyond(ratios, ed.NODE_BOUND)]
    if not rows:
        return 'No stream is above the bounds.\n'
    return md.folded('%d results above the bounds (offline %g, on hard streams %g, node %g)' % (
        len(rows), ed.WORST_BOUND, ed.HARD_BOUND, ed.NODE_BOUND),
        md.table(['', 'stream', 'ratio', 'bound'], rows, left=2))


def streams_table(figures):
    rows = []
    for stream in figures.streams('offline'):
        error = figures.value('offline', stream, ed.DEFAULT, 'error')
        best = figures.value('offline', stream, ed.FILTER, 'error')
        window = figures.value('offline', stream, ed.FILTER, 'window_ms')
        noise = figures.value('offline', stream, ed.DEFAULT, 'position_noise_rad')
        rows.append([stream_name(stream), '%.2g' % (100 * error), '%.2g' % (100 * best),
                     md.ratio(error / best), '%.0f' % window, md.error(noise)])
    return md.folded('All streams', md.table(
        ['stream', 'error, %', 'best filter, %', 'ratio', 'its window, ms',
         'noise found (median joint), rad'], rows))


def node_table(figures):
    rows = []
    for lag in figures.lags():
        grid = figures.node_ratios(lag, (ed.GRID,))
        hard = figures.node_ratios(lag, ed.HARD)
        first = figures.node_ratios(lag, (ed.GRID,), 'first_second_error')
        gains = figures.velocity_gains(lag)
        rows.append(['%g' % lag] + _median_worst(grid)[:2] + _median_worst(hard)[:2]
                    + [md.ratio(ed.median(first)), md.ratio(ed.median(gains)),
                       md.ratio(ed.worst(gains)[0])])
    return md.table(['lag, ms', 'grid: median', 'worst', 'hard: median', 'worst',
                     'first second: median', 'with over without velocities: median', 'worst'], rows,
                    left=0)


def wrong_table(figures):
    rows = []
    for kind in ed.WRONG:
        cells = [WRONG_NAMES[kind]]
        for lag in (ed.OFFLINE_LAG, ed.NODE_LAG):
            ratios = figures.wrong_ratios(kind, lag)
            found = [figures.value('wrong_velocities', s, ed.DEFAULT, 'velocity_ratio', lag)
                     for s in ratios]
            cells += [md.ratio(ed.median(ratios)), md.ratio(ed.worst(ratios)[0]),
                      '%.3g to %.3g' % (min(found), max(found))]
        rows.append(cells)
    return md.table(['velocities', 'offline: median', 'worst', 'ratio found', 'node: median',
                     'worst', 'ratio found'], rows)


def calibration_table(figures):
    rows = []
    for method, name in ((ed.DEFAULT, 'offline'), (ed.NODE, 'node, %g ms' % ed.NODE_LAG)):
        for quantity in ('acceleration', 'effort'):
            shares = figures.calibration(method, quantity)
            if not shares:
                continue
            least = min(shares, key=shares.get)
            rows.append([name, quantity, stream_name(least), percent(shares[least]),
                         percent(ed.median(shares)), percent(max(shares.values())),
                         percent(ed.share_calibrated(shares))])
    return md.table(['', '', 'least in', 'least', 'median', 'most', 'streams within 90 to 99 %'],
                    rows, left=3)


def _recording(figures, part='recording'):
    return {(f.method, f.lag): value for f, value in figures.of_part(part)}


RECORDING_NAMES = {
    ed.DEFAULT: 'defaults, offline', 'default_positions_only': 'defaults, offline, positions only',
    'butterworth': 'best zero-phase Butterworth filter', ed.FILTER: 'best Savitzky–Golay filter',
    ed.NODE: 'node'}


def recording_rows(figures):
    """[(name, share explained of all rows, share explained of the late rows)]"""
    late = _recording(figures, 'recording_late')
    return [(RECORDING_NAMES[key[0]] + (', lag %g ms' % key[1] if key[1] >= 0 else ''), value,
             late[key]) for key, value in _recording(figures).items()]


def explained(value):
    return '%.3f' % value if value > -10 else '%.0f' % value


def recording_table(figures):
    rows = [[name] + [explained(value) for value in values]
            for name, *values in recording_rows(figures)]
    return md.table(['', 'from the start', 'after the first second'], rows) if rows \
        else 'There was no recording (`--recording FOLDER`).\n'


def time_table(figures):
    rows = [['%d' % f.stream.rate, 'yes' if f.stream.velocities == 'good' else 'no',
             '%.1f' % (value / 1000), '%.1f' % (f.stream.rate * value / 1e7)]
            for f, value in figures.of_part('time')]
    return md.table(['Hz', 'velocities', 'µs per sample', '% of a core'], rows, left=0)


def long_run_text(figures):
    if figures is None:
        return 'The long run was not made (`estimator_error --long-run 86400000`).\n'
    found = figures.of_part('long_run')
    parts = list(dict.fromkeys(f.method for f, _ in found))
    rows = []
    for part in (parts[0], parts[len(parts) // 2], parts[-1]):
        values = {f.quantity: value for f, value in found if f.method == part}
        rows.append(['%s of %d' % (part.split('_')[1], len(parts))] + [
            '%.3g' % values[q] for q in ('q_rms_rad', 'qd_rms_rad_s', 'qdd_rms_rad_s2')])
    return md.table(['part', 'position, rad', 'velocity, rad/s', 'acceleration, rad/s²'], rows)
