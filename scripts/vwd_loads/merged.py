"""The report of many motions, from what the report of each has left in sums.json."""
import csv
import json
import math
import os
from collections import OrderedDict

from vwd_loads.document import Figure, Heading, Items, Table, Text, as_html, as_markdown, number_text
from vwd_loads.errors import ReportError
from vwd_loads.loads import SUMS, SUMS_FORMAT

OUTCOME = 'outcome.txt'  # in the folder of a motion of the workflow
FAILED = 'failed: '  # begins it, before the reason, where there is no report
CURVES = (('effort', 'N m'), ('effort', 'N'), ('force', 'N'), ('tilting_moment', 'N m'))


class Merged:
    """One quantity of one joint over all motions."""

    def __init__(self, first):
        self.name, self.quantity, self.unit = first['name'], first['quantity'], first['unit']
        self.words = first['words']
        self.motions, self.seconds, self.weighted, self.squares = 0, 0.0, 0.0, 0.0
        self.peak, self.peak_motion, self.peak_time = 0.0, '', None
        self.peaks = []
        self.cycles, self.travel = 0.0, 0.0
        self.counted = first['cycles'] is not None  # whether it has cycles, or could have
        self.turns = False  # whether it turns in any
        self._once, self._ball, self._roller = [], [], []

    def add(self, load, motion):
        self.motions += 1
        weight = load['seconds'] or 0.0
        self.seconds += weight
        self.weighted += weight * load['mean']
        self.squares += weight * load['rms'] ** 2
        self.peaks.append(abs(load['peak']))
        if abs(load['peak']) > abs(self.peak) or not self.peak_motion:
            self.peak, self.peak_motion, self.peak_time = load['peak'], motion, load['peak_time']
        self.cycles += load['cycles'] or 0.0
        self._once.append((load['range_once'] or 0.0, 1.0))
        if load['ball'] is not None:
            self.turns = True
            self.travel += load['travel']
            self._ball.append((load['ball'], load['travel']))
            self._roller.append((load['roller'], load['travel']))

    @property
    def mean(self):
        return self.weighted / self.seconds if self.seconds > 0 else None

    @property
    def rms(self):
        return math.sqrt(self.squares / self.seconds) if self.seconds > 0 else None

    @property
    def ball(self):
        return power_mean(self._ball, 3.0, self.travel)

    @property
    def roller(self):
        return power_mean(self._roller, 10.0 / 3.0, self.travel)

    def range_once(self, woehler):
        return power_mean(self._once, woehler, 1.0) if self.counted else None

    def range(self, woehler):
        if not self.counted or self.cycles == 0:
            return 0.0 if self.counted else None
        return power_mean(self._once, woehler, self.cycles)


def power_mean(values, exponent, total):
    """(sum weight value^exponent / total)^(1/exponent); None for nothing."""
    largest = max((value for value, _ in values), default=0.0)
    if total <= 0:
        return None
    if largest == 0:
        return 0.0
    return largest * (sum(weight * (value / largest) ** exponent for value, weight in values)
                      / total) ** (1 / exponent)


def _folders(words):
    folders = []
    for word in words:
        if not word.startswith('@'):
            folders.append(word)
            continue
        with open(word[1:], encoding='utf-8') as file:
            folders += [line.strip() for line in file if line.strip()]
    return folders


def _read(folder):
    """The sums of a folder. Raises ReportError with the reason why there are none."""
    outcome = os.path.join(folder, OUTCOME)
    if os.path.exists(outcome):
        with open(outcome, encoding='utf-8', errors='replace') as file:
            line = file.readline().strip()
        if line.startswith(FAILED):
            raise ReportError(line[len(FAILED):])
    try:
        with open(os.path.join(folder, SUMS), encoding='utf-8') as file:
            sums = json.load(file)
    except OSError as error:
        raise ReportError('no report: %s' % error.strerror)
    except ValueError:
        raise ReportError('its %s is broken' % SUMS)
    if not isinstance(sums, dict) or sums.get('format') != SUMS_FORMAT:
        raise ReportError('its %s has another format' % SUMS)
    missing = _missing(sums)
    if missing:
        raise ReportError('its %s is incomplete: %s' % (SUMS, missing))
    return sums


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_number_or_none(value):
    return value is None or _is_number(value)


def _is_text(value):
    return isinstance(value, str)


# What is read of the sums of a motion, and of each of its loads.
OF_MOTION = {'robot': _is_text, 'rows': _is_number, 'doubtful_rows': _is_number, 'seconds': _is_number,
             'woehler': _is_number, 'loads': lambda value: isinstance(value, list)}
OF_LOAD = {'name': _is_text, 'quantity': _is_text, 'unit': _is_text, 'words': _is_text, 'mean': _is_number,
           'rms': _is_number, 'peak': _is_number, 'peak_time': _is_number_or_none,
           'seconds': _is_number_or_none, 'cycles': _is_number_or_none, 'range_once': _is_number_or_none,
           'ball': _is_number_or_none, 'roller': _is_number_or_none, 'travel': _is_number_or_none}


def _missing(sums):
    """What the sums lack, or have of another kind; empty: nothing."""
    for key, fits in OF_MOTION.items():
        if not fits(sums.get(key)):
            return key
    for i, load in enumerate(sums['loads']):
        if not isinstance(load, dict):
            return 'load %d' % (i + 1)
        for key, fits in OF_LOAD.items():
            if key not in load or not fits(load[key]):
                return '%s of load %d' % (key, i + 1)
    return ''


class Fleet:
    """All motions that could be read, and those that could not."""

    def __init__(self, folders):
        self.sums, self.failures = [], []
        for folder in folders:
            try:
                self.sums.append((os.path.basename(os.path.normpath(folder)), _read(folder)))
            except ReportError as error:
                self.failures.append((os.path.basename(os.path.normpath(folder)), str(error)))
        exponents = {sums['woehler'] for _, sums in self.sums}
        if len(exponents) > 1:
            raise ReportError('reports of different Wöhler exponents: %s'
                              % ', '.join(number_text(e) for e in sorted(exponents)))
        robots = {sums['robot'] for _, sums in self.sums}
        if len(robots) > 1:
            raise ReportError('reports of different robots: %s' % ', '.join(sorted(robots)))
        self.woehler = exponents.pop() if exponents else None
        self.robot = robots.pop() if robots else ''
        self.merged = OrderedDict()
        for motion, sums in self.sums:
            for load in sums['loads']:
                key = load['name'], load['quantity']
                self.merged.setdefault(key, Merged(load)).add(load, motion)


def write_merged(words, folder):
    """Writes merged reports of the folders of others. Returns a line about it."""
    fleet = Fleet(_folders(words))
    os.makedirs(os.path.join(folder, 'figures'), exist_ok=True)
    _write_csv(fleet, os.path.join(folder, 'loads.csv'))
    _write_motions(fleet, os.path.join(folder, 'motions.csv'))
    title = 'Loads of %s in %d motions' % (fleet.robot or 'a robot', len(fleet.sums))
    blocks = _blocks(fleet, folder)
    for name, text in (('report.md', as_markdown(title, blocks, folder)),
                       ('report.html', as_html(title, blocks))):
        with open(os.path.join(folder, name), 'w', encoding='utf-8') as file:
            file.write(text)
    return '%d motions, %d without a report: %s' % (len(fleet.sums), len(fleet.failures),
                                                    os.path.join(folder, 'report.html'))


def _write_csv(fleet, path):
    with open(path, 'w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['name', 'quantity', 'unit', 'motions', 'seconds', 'mean', 'rms', 'equivalent_ball',
                         'equivalent_roller', 'travel', 'woehler', 'range', 'cycles', 'range_once', 'peak',
                         'peak_time', 'peak_motion'])
        for merged in fleet.merged.values():
            figures = [merged.seconds, merged.mean, merged.rms, merged.ball, merged.roller,
                       merged.travel if merged.turns else None,
                       fleet.woehler, merged.range(fleet.woehler),
                       merged.cycles if merged.counted else None,
                       merged.range_once(fleet.woehler), merged.peak, merged.peak_time]
            writer.writerow([merged.name, merged.quantity, merged.unit, merged.motions]
                            + ['' if figure is None else repr(figure) for figure in figures]
                            + [merged.peak_motion])


def _write_motions(fleet, path):
    with open(path, 'w', newline='', encoding='utf-8') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['motion', 'rows', 'seconds', 'doubtful_rows', 'problem'])
        for motion, sums in fleet.sums:
            writer.writerow([motion, sums['rows'], repr(sums['seconds']), sums['doubtful_rows'], ''])
        for motion, reason in fleet.failures:
            writer.writerow([motion, '', '', '', reason])


def _blocks(fleet, folder):
    seconds = sum(sums['seconds'] for _, sums in fleet.sums)
    rows = sum(sums['rows'] for _, sums in fleet.sums)
    blocks = [Text('%d motions of %s s together, %d rows.' % (len(fleet.sums), number_text(seconds), rows), 'lead')]
    if fleet.failures:
        blocks.append(Text('%d without a report: they are listed below, and in no figure.' % len(fleet.failures),
                           'warning'))
    blocks += _tables(fleet) + _figures(fleet, folder)
    doubtful = [(motion, sums) for motion, sums in fleet.sums if sums['doubtful_rows']]
    if doubtful:
        doubtful.sort(key=lambda item: -item[1]['doubtful_rows'] / item[1]['rows'])
        blocks += [Heading(2, 'Rows to distrust'),
                   Text('Motions with such rows, those with the largest part first; their own reports say why.'),
                   Table(['motion', 'rows', 'to distrust'],
                         [[m, str(s['rows']), str(s['doubtful_rows'])] for m, s in doubtful[:50]])]
    if fleet.failures:
        blocks += [Heading(2, 'Without a report'),
                   Items(['`%s`: %s' % failure for failure in fleet.failures])]
    return blocks + [Heading(2, 'How the figures are found'), Items([
        'Means and rms are over the time of all motions, equivalent bearing loads over the travel of all, and '
        'cycles and their damage add up; no cycle reaches from one motion into the next.',
        'Percentiles do not add up: those of each motion are in its own `loads.csv`.',
        'The report of each motion says how the rest is found.'])]


def _tables(fleet):
    rows = []
    for merged in fleet.merged.values():
        if merged.quantity in ('fx', 'fy', 'fz', 'tx', 'ty', 'tz'):
            continue
        rows.append([merged.name, merged.words, merged.unit, number_text(merged.peak), merged.peak_motion,
                     number_text(merged.peak_time, 5)]
                    + [number_text(x) for x in (
                        merged.mean, merged.rms, merged.ball, merged.roller, merged.range_once(fleet.woehler),
                        merged.range(fleet.woehler), merged.cycles if merged.counted else None)])
    if not rows:
        return []
    return [Heading(2, 'Loads'),
            Table(['', '', 'in', 'peak', 'in motion', 'at, s', 'mean', 'rms', 'equivalent, ball',
                   'equivalent, roller', 'damage, m = %s: range of one cycle' % number_text(fleet.woehler),
                   'range of N cycles', 'N'],
                  rows, 3)]


def _figures(fleet, folder):
    from vwd_loads import plots
    figures = []
    for quantity, unit in CURVES:
        peaks = OrderedDict((merged.name, merged.peaks) for merged in fleet.merged.values()
                            if merged.quantity == quantity and merged.unit == unit)
        if peaks:
            words = next(m.words for m in fleet.merged.values() if m.quantity == quantity)
            path = os.path.join(folder, 'figures', 'peaks_%s_%s.svg' % (quantity, unit.replace(' ', '')))
            figures.append(Figure(plots.peaks_of_motions(peaks, unit, words, path),
                                  'Peaks of %s of each motion, in order: whether the largest is one of many or '
                                  'stands alone.' % words))
    return [Heading(2, 'Peaks of the motions')] + figures if figures else []
