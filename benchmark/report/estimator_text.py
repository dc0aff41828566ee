"""Tables and sentences of the estimator's page, from its data."""
import collections
import math

import estimator_data as ed
import markdown_text as md
from estimator_plots import brief, encoder_name, percent

SHORT_DELAY, LONG_DELAY = 8, 32  # ms
POOR = 2  # times as much error as another setting with no more delay


def ms(value):
    return '%.3g ms' % value


def setting_text(setting):
    return '%d/%d/%d' % setting


def setting_words(setting, rate):
    return 'window %d, order %d, lag %d (%s)' % (setting + (ms(1000.0 * setting.lag / rate),))


def share(value):
    return percent(value) + ' %'


def _effort_cell(row):
    return '%s (%s)' % (share(row.effort_rms_share), setting_text(row.setting)) if row else md.NONE


def _acceleration_cell(row):
    return '%s (%s)' % (brief(row.qdd_rms_rad_s2), setting_text(row.setting)) if row else md.NONE


def extent(data):
    return ('This run: %s Hz; %d streams of joint states (rate, motion, encoder, velocities, '
            'stamps), %s settings and methods tried on them altogether.' % (
                md.listed(str(rate) for rate in data.rates), len(data.streams),
                '{:,}'.format(data.row_count)))


def grid_text(data):
    settings = list(data.grid(data.streams[0]))
    return 'windows %s, orders %s, lags %s as far as the middle of the window' % (
        md.listed(str(n) for n in sorted({s.window for s in settings})),
        md.listed(str(n) for n in sorted({s.order for s in settings})),
        md.listed(str(n) for n in sorted({s.lag for s in settings})))


def motions_table(data):
    rows = []
    for motion, frequency in data.motions.items():
        size = data.size(motion)
        rows.append([motion, brief(frequency)] + [brief(value) for value in size[3:9]])
    return md.table(['motion', 'highest frequency, Hz', 'velocity RMS, rad/s', 'largest',
                     'acceleration RMS, rad/s²', 'largest', 'effort RMS, N m', 'largest'], rows)


def encoders_table(data):
    rows = []
    for name, encoder in data.encoders.items():
        exact = not encoder.counts
        rows.append([encoder_name(name), '`%s`' % name,
                     md.NONE if exact else '{:,}'.format(encoder.counts),
                     md.NONE if exact else '1:%g' % encoder.gear,
                     '0' if exact else '%.2g' % ed.step(encoder), '%.2g' % encoder.noise,
                     '0' if exact else '%.2g' % ed.reading_noise(encoder)])
    return md.table(['encoder', 'in the CSV', 'counts a turn of its shaft', 'gear',
                     'one count at the joint, rad', 'noise RMS, counts',
                     'rounding and noise at the joint, rad RMS'], rows, left=2)


def best_table(data, motion, velocity, stamps):
    """The best settings of each rate and encoder by effort, within limits of delay."""
    rows = []
    for stream in data.streams:
        if (stream.motion, stream.velocity, stream.stamps) != (motion, velocity, stamps):
            continue
        naive = data.find(stream._replace(velocity='none'), ed.DIFFERENCES)
        rows.append([str(stream.rate), encoder_name(stream.encoder),
                     _effort_cell(data.find(stream, ed.DEFAULT)),
                     _effort_cell(data.best(stream, 0)),
                     _effort_cell(data.best(stream, SHORT_DELAY)),
                     _effort_cell(data.best(stream, LONG_DELAY)), _effort_cell(data.best(stream)),
                     share(naive.effort_rms_share) if naive else md.NONE,
                     share(data.find(stream, ed.ZERO).effort_rms_share)])
    return md.table(['Hz', 'encoder', 'default', 'best without delay'] + _limits() + [
        'best with any delay', 'differenced twice', 'zero'], rows, left=2)


def _limits():
    return ['best to %d ms' % limit for limit in (SHORT_DELAY, LONG_DELAY)]


def acceleration_table(data):
    rows = []
    for stream in data.streams:
        if stream[1:2] + stream[3:] != (ed.USUAL_MOTION, 'none', 'true'):
            continue
        best = [data.best(stream, limit, 'qdd_rms_rad_s2')
                for limit in (0, SHORT_DELAY, LONG_DELAY, math.inf)]
        rows.append([str(stream.rate), encoder_name(stream.encoder)]
                    + [_acceleration_cell(row) for row in [data.find(stream, ed.DEFAULT)] + best]
                    + [brief(data.find(stream, ed.DIFFERENCES).qdd_rms_rad_s2)])
    return md.table(['Hz', 'encoder', 'default', 'best without delay'] + _limits() + [
        'best with any delay', 'differenced twice'], rows, left=2)


def _sizes_table(data):
    """All errors of the default and of the best setting with little delay."""
    rows = []
    for stream in data.streams:
        if stream[1:2] + stream[3:] != (ed.USUAL_MOTION, 'none', 'true'):
            continue
        for row in (data.find(stream, ed.DEFAULT), data.best(stream, LONG_DELAY)):
            rows.append([str(stream.rate), encoder_name(stream.encoder), setting_text(row.setting),
                         brief(ed.delay(row))]
                        + [brief(value) for value in row[3:9]]
                        + [percent(row.effort_rms_share), percent(row.effort_max_share)])
    return md.table(['Hz', 'encoder', 'window/order/lag', 'delay, ms', 'velocity RMS, rad/s', 'max',
                     'acceleration RMS, rad/s²', 'max', 'effort RMS, N m', 'max',
                     'effort RMS, % of range', 'max'], rows, left=2)


def folded_tables(data):
    parts = [md.folded('RMS and largest errors of the default and of the best setting to %d ms, '
                       '%s motion' % (LONG_DELAY, ed.USUAL_MOTION), _sizes_table(data))]
    kinds = dict.fromkeys(stream[1:2] + stream[3:] for stream in data.streams)
    names = {'none': 'no velocities', 'differences': 'velocities by differences',
             'exact': 'exact velocities'}
    for motion, velocity, stamps in kinds:
        if (motion, velocity, stamps) != (ed.USUAL_MOTION, 'none', 'true'):
            parts.append(md.folded('Efforts: %s motion, %s, %s stamps' % (
                motion, names[velocity], stamps), best_table(data, motion, velocity, stamps)))
    return '\n'.join(parts)


def _velocity_ratios(data, rate, source, pick):
    """Error with velocities over error without, for each real encoder and motion."""
    found = []
    for stream in data.streams:
        if (stream.rate, stream.velocity, stream.stamps) == (rate, source, 'true') \
                and stream.encoder != ed.EXACT_ENCODER:
            without = pick(stream._replace(velocity='none'))
            found.append(ed.what_matters(pick(stream).effort_rms_share)
                         / ed.what_matters(without.effort_rms_share))
    return found


def velocities_table(data):
    """What velocities do, over real encoders with true stamps."""
    picks = (('default', lambda stream: data.find(stream, ed.DEFAULT)),
             ('best to %d ms' % LONG_DELAY, lambda stream: data.best(stream, LONG_DELAY)))
    rows = []
    for rate in data.rates:
        row = [str(rate)]
        for source in ('differences', 'exact'):
            for _, pick in picks:
                ratios = _velocity_ratios(data, rate, source, pick)
                row.append('%.2f (%.2f to %.2f)' % (
                    ed.geometric_mean(ratios), min(ratios), max(ratios)) if ratios else md.NONE)
        rows.append(row)
    header = ['Hz'] + ['%s: %s' % (source, name) for source in ('differences', 'exact')
                       for name, _ in picks]
    return md.table(header, rows)


def kinds_text(streams):
    motions = dict.fromkeys(stream.motion for stream in streams)
    wrong = len([stream for stream in streams if stream.stamps == 'wrong'])
    return ('encoders that are not exact; motions: %s; velocities: none and differences; %d of '
            'them with wrong stamps' % (md.listed(motions), wrong))


def _lag_limits(data, rate):
    """[(name, longest lag in samples)]"""
    limits = [('no lag', 0), ("at most the default's lag", data.default.lag)]
    within = LONG_DELAY * rate // 1000
    if within != data.default.lag:
        limits.append(('at most %d ms' % LONG_DELAY, within))
    return limits + [('any lag', math.inf)]


def recommended_table(data):
    rows = []
    for rate in data.rates:
        for name, longest in _lag_limits(data, rate):
            merits = data.merits(data.realistic(rate), longest)
            rows.append([str(rate), name] + _merit_cells(merits[0], rate)
                        + [md.ratio(data.default_merit(merits).times_best)
                           if longest >= data.default.lag else md.NONE])
        default = data.default_merit(data.merits(data.realistic(rate)))
        rows.append([str(rate), '*default*'] + _merit_cells(default, rate)
                    + [md.ratio(default.times_best)])
    return md.table(['Hz', 'limit of the lag', 'window/order/lag', 'window, ms', 'delay, ms',
                     'typical error', 'worst stream', 'times best', 'default: times best'],
                    rows, left=2)


def _merit_cells(merit, rate):
    return [setting_text(merit.setting), '%.0f' % ed.length(merit.setting, rate),
            '%.3g' % (1000.0 * merit.setting.lag / rate), share(merit.typical),
            share(merit.largest), md.ratio(merit.times_best)]


def orders_table(data):
    rows = []
    for rate in data.rates:
        first = {}
        for merit in data.merits(data.realistic(rate)):
            first.setdefault(merit.setting.order, merit)
        for order in sorted(first):
            rows.append([str(rate), str(order)] + _merit_cells(first[order], rate))
    return md.table(['Hz', 'order', 'window/order/lag', 'window, ms', 'delay, ms', 'typical error',
                     'worst stream', 'times best'], rows, left=2)


def now_table(data):
    rows = []
    for rate in data.rates:
        merits = data.merits(data.realistic(rate), error=ed.EFFORT_NOW)
        default = data.default_merit(merits)
        rows.append([str(rate)] + _merit_cells(merits[0], rate)
                    + [share(default.typical), md.ratio(default.times_best)])
    return md.table(['Hz', 'window/order/lag', 'window, ms', 'delay, ms', 'typical error',
                     'worst stream', 'times best', 'default: typical error',
                     'default: times best'], rows)


def _times(default, other):
    return md.ratio(default.typical / other.typical)


def _verdict_of_rate(data, rate):
    limited = data.merits(data.realistic(rate), data.default.lag)
    free = data.merits(data.realistic(rate))
    default = data.default_merit(free)
    poor = default.typical > POOR * limited[0].typical
    return ('**%d Hz: the default is %s.** It typically errs %s times as much as %s, which has no '
            'more lag, and %s times as much as %s.' % (
                rate, 'poor' if poor else 'acceptable', _times(default, limited[0]),
                setting_words(limited[0].setting, rate), _times(default, free[0]),
                setting_words(free[0].setting, rate)))


def _verdict_of_all(data):
    limited = data.merits(data.realistic(), data.default.lag)
    free = data.merits(data.realistic())
    default = data.default_merit(free)
    return ('One setting for all rates: %s with no more lag than the default, which errs %s times '
            'as much; %s with any lag (%s times).' % (
                setting_text(limited[0].setting), _times(default, limited[0]),
                setting_text(free[0].setting), _times(default, free[0])))


def _verdict_of_windows(data):
    best = [data.merits(data.realistic(rate))[0].setting for rate in data.rates]
    lengths = [ed.length(setting, rate) for setting, rate in zip(best, data.rates)]
    line = 'The best windows at %s Hz are %s long, with any lag' % (
        md.listed(str(rate) for rate in data.rates), md.listed(ms(value) for value in lengths))
    longest = max(setting.window for stream in data.streams for setting in data.grid(stream))
    ended = [str(rate) for setting, rate in zip(best, data.rates) if setting.window == longest]
    if ended:
        line += ' (at %s Hz the longest that was tried, %d samples)' % (md.listed(ended), longest)
    if len(best) > 1 and max(lengths) / min(lengths) < 0.5 * data.rates[-1] / data.rates[0]:
        line += ': a fixed time suits all rates better than a fixed number of samples does'
    return line + '.'


def verdict(data):
    """The recommendation in sentences."""
    lines = [_verdict_of_rate(data, rate) for rate in data.rates]
    lines += [_verdict_of_all(data), _verdict_of_windows(data)]
    return '\n'.join('- ' + line for line in lines)


def _short_of_rate(data, rate):
    streams = data.realistic(rate)
    limited, free = data.merits(streams, data.default.lag), data.merits(streams)
    return ('%d Hz: the default settings, %s, leave a typical error of the effort of %s of its '
            'range (%d streams). The best settings for all of them: %s, %s; with any lag %s, '
            '%s.' % (
                rate, setting_words(data.default, rate), share(data.default_merit(free).typical),
                len(streams), setting_words(limited[0].setting, rate), share(limited[0].typical),
                setting_words(free[0].setting, rate), share(free[0].typical)))


def _worse_than_zero(data):
    counts = collections.defaultdict(collections.Counter)
    worse = data.worse_than_zero()
    for row in worse:
        true = row.stream.stamps == 'true'
        counts[row.stream.rate][encoder_name(row.stream.encoder) if true else 'wrong stamps'] += 1
    where = ['at %d Hz %s' % (rate, ', '.join('%s (%d)' % pair for pair in found.items()))
             for rate, found in counts.items()]
    return 'On %d of %d streams the default does worse than taking accelerations as zero%s.' % (
        len(worse), len(data.realistic()), ': ' + '; '.join(where) if where else '')


def _naive(data):
    ratios = [data.find(stream, ed.DIFFERENCES).effort_rms_share
              / data.find(stream, ed.DEFAULT).effort_rms_share
              for stream in data.realistic() if stream.velocity == 'none']
    return ('Positions differenced twice err %s times as much as the default (geometric mean of %d '
            'streams without velocities; %s to %s), and less on %d of them.' % (
                md.ratio(ed.geometric_mean(ratios)), len(ratios), md.ratio(min(ratios)),
                md.ratio(max(ratios)), sum(ratio < 1 for ratio in ratios)))


def short_version(data):
    lines = [_short_of_rate(data, rate) for rate in data.rates]
    lines += [_worse_than_zero(data), _naive(data)]
    return '\n'.join('- ' + line for line in lines)
