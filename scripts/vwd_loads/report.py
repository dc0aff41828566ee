"""The report of one motion: report.md, report.html, loads.csv, sums.json and pictures."""
import os
import re

import numpy as np

from vwd_loads import doubts as doubting
from vwd_loads import spectrum as spectra
from vwd_loads.document import Figure, Heading, Items, Table, Text, as_html, as_markdown, number_text
from vwd_loads.explanations import axes_words, explanations
from vwd_loads.loads import SUMS, Loads, sums_of, write_csv, write_json
from vwd_loads.pieces import pieces_of
from vwd_loads.quantities import state_columns
from vwd_loads.statistics import weighted_rms

POSTURES = ('force', 'tilting_moment', 'moment', 'effort')  # of which the worst posture is shown
COUNTED = ('effort', 'fx', 'fy', 'fz', 'tx', 'ty', 'tz')
DAGGER = '†'
ROUNDED = 1e-20  # densities, in 1/Hz of the square, that are rounding of what does not change


class Report:
    """Finds everything and writes it into a folder."""

    def __init__(self, table, mechanism, settings, folder, progress):
        self.table = table
        self.mechanism = mechanism
        self.folder = folder
        self.progress = progress
        self.loads = Loads(table, mechanism, settings, progress.named('counting'))
        self.parts = self.loads.parts
        self.clock = spectra.Clock(table.times, self.loads.gap)
        self.doubts = doubting.doubts_of(table, self.parts)
        self.doubted = {key: doubting.rows_of(self.doubts, key[0], key[1], len(table)) for key in self.loads.of}
        self.short_spectra = False  # whether pieces were too short for one

    # --- files ---------------------------------------------------------------------------------------

    def write_figures_only(self):
        """loads.csv and sums.json."""
        os.makedirs(self.folder, exist_ok=True)
        write_csv(self.loads, os.path.join(self.folder, 'loads.csv'))
        doubted = np.zeros(len(self.table), dtype=bool)
        for doubt in self.doubts:
            # What is never determined, as across a plane mechanism, says nothing of a row.
            if doubt.quantities is None or not np.all(doubt.rows):
                doubted |= doubt.rows
        write_json(sums_of(self.loads, int(np.sum(doubted))), os.path.join(self.folder, SUMS))

    def write(self):
        self.write_figures_only()
        os.makedirs(os.path.join(self.folder, 'figures'), exist_ok=True)
        title = 'Loads of %s' % (self.mechanism.robot or os.path.basename(self.table.path))
        blocks = self._blocks()
        for name, text in (('report.md', as_markdown(title, blocks, self.folder)),
                           ('report.html', as_html(title, blocks))):
            with open(os.path.join(self.folder, name), 'w', encoding='utf-8') as file:
                file.write(text)

    def _figure_path(self, *words):
        name = '_'.join(re.sub(r'[^\w.-]', '_', word) for word in words)
        return os.path.join(self.folder, 'figures', name + '.svg')

    # --- contents ------------------------------------------------------------------------------------

    def _blocks(self):
        of_parts = self._parts()  # first: they say whether spectra were possible
        return (self._beginning() + self._summary() + self._limits() + self._doubts() + self._postures()
                + of_parts + explanations(self.loads, self.clock, self.short_spectra))

    def _beginning(self):
        times = self.table.times
        sources = ', '.join('%s `%s`' % source for source in self.mechanism.sources)
        text = '%d rows from %s s to %s s' % (len(times), number_text(times[0], 6), number_text(times[-1], 6))
        if self.clock.rate:
            text += ', about %s each second' % number_text(self.clock.rate)
        blocks = [Text('%s; results `%s`%s.' % (text, self.table.path, '; ' + sources if sources else ''),
                       'lead')]
        gaps = len(self.loads.pieces) - 1
        if gaps > 0:
            blocks.append(Text('%d %s longer than %s s: nothing is assumed across, neither means nor cycles '
                               'nor spectra.' % (gaps, 'gap' if gaps == 1 else 'gaps',
                                                 number_text(self.loads.gap)), 'warning'))
        if not self.mechanism.known:
            blocks.append(Text('Nothing is known of the joints: no radial and axial parts, no equivalent bearing '
                               'loads, no limits. Results as `.npz` say it, or `--mechanism`.', 'warning'))
        elif self.mechanism.axes != 'child':
            blocks.append(Text('Reactions are in %s, in which axes of joints move: there are no radial and axial '
                               'parts. Compute with `--axes child` for these.' % axes_words(self.mechanism.axes),
                               'warning'))
        return blocks

    def _peak_text(self, load):
        if load is None or load.peak is None:
            return '–'
        mark = DAGGER if self.doubted[load.part.name, load.quantity.name][load.peak_row] else ''
        return self._text(load, load.peak) + mark

    def _text(self, load, value):
        """A figure in the load's own unit, without rounding errors."""
        return '0' if self.loads.is_rounding(load, value) else number_text(value)

    def _summary(self):
        columns = [('peak effort', 'effort', self._peak_text),
                   ('rms effort', 'effort', lambda load: self._text(load, load.rms)),
                   ('damage of effort, range of one cycle', 'effort', lambda load: self._text(load, load.range_once)),
                   ('peak radial force, N', 'radial_force', self._peak_text),
                   ('peak axial force, N', 'axial_force', self._peak_text),
                   ('peak tilting moment, N m', 'tilting_moment', self._peak_text),
                   ('peak force, N', 'force', self._peak_text),
                   ('peak moment, N m', 'moment', self._peak_text),
                   ('equivalent force, ball, N', 'force', lambda load: self._text(load, load.ball)),
                   ('equivalent force, roller, N', 'force', lambda load: self._text(load, load.roller))]
        loads = [[self.loads.get(part, quantity) for _, quantity, _ in columns] for part in self.parts]
        used = [any(row[i] is not None and row[i].peak is not None for row in loads)
                for i in range(len(columns))]
        rows = []
        for part, row in zip(self.parts, loads):
            unit = part.effort.effort_unit if part.quantity('effort') else ''
            cells = [text(load) if load is not None and load.peak is not None else '–'
                     for keep, (_, _, text), load in zip(used, columns, row) if keep]
            rows.append([part.name, self._kind(part), unit] + cells)
        header = ['', '', 'effort in'] + [words for keep, (words, _, _) in zip(used, columns) if keep]
        blocks = [Heading(2, 'Summary'), Table(header, rows, 3)]
        if any(DAGGER in cell for row in rows for cell in row):
            blocks.append(Text(DAGGER + ' in a row that is not to be trusted, see below.', 'note'))
        return blocks

    @staticmethod
    def _kind(part):
        if part.reaction is None:
            return ''
        kind = part.reaction.kind
        return part.reaction.type if kind == 'joint' else (kind + ' ' + part.reaction.type).strip()

    def _limits(self):
        rows, bars = [], []
        for part in self.parts:
            load = self.loads.get(part, 'effort')
            if load is None or load.peak is None:
                continue
            row, bar = self._limit_row(part, load)
            rows.append(row)
            if bar:
                bars.append((part.name, bar))
        if not rows:
            return []
        header = ['', 'effort in', 'limit of effort', 'peak / limit', 'rms / limit', 'rows beyond',
                  'first beyond, s', 'limit of speed', 'peak speed', 'peak / limit', 'peak power, W',
                  'mean driving power, W']
        blocks = [Heading(2, 'Motors')] + self._beyond() + [_without_empty(header, rows, 2)]
        if bars:
            from vwd_loads import plots
            path = plots.limits_used(bars, self._figure_path('limits'))
            blocks.append(Figure(path, 'How much of the limits of the description the motion uses.'))
        return blocks + self._deviations()

    def _beyond(self):
        blocks = []
        for part in self.parts:
            effort, load = part.effort, self.loads.get(part, 'effort')
            if load is None:
                continue
            for words, values, limit, unit in (
                    ('effort', load.quantity.values, effort.effort_limit, effort.effort_unit),
                    ('speed', part.velocity, effort.velocity_limit, effort.velocity_unit)):
                if not limit or values is None:
                    continue
                rows = np.abs(values) > limit
                if np.any(rows):
                    blocks.append(Text('`%s`: %s beyond the limit of %s %s in %d rows, %s.' % (
                        part.name, words, number_text(limit), unit, np.sum(rows),
                        doubting.spans(rows, self.table.times)), 'warning'))
        return blocks

    def _limit_row(self, part, load):
        effort, values, bar = part.effort, load.quantity.values, {}
        row = [part.name, effort.effort_unit, number_text(effort.effort_limit)]
        if effort.effort_limit:
            beyond = np.flatnonzero(np.abs(values) > effort.effort_limit)
            bar['peak effort'] = abs(load.peak) / effort.effort_limit
            bar['rms effort'] = load.rms / effort.effort_limit
            row += [_percent(bar['peak effort']), _percent(bar['rms effort']), str(len(beyond)),
                    number_text(self.table.times[beyond[0]], 5) if len(beyond) else '–']
        else:
            row += ['–'] * 4
        velocity = part.velocity
        if velocity is None:
            return row + ['–'] * 5, bar
        fastest = float(np.nanmax(np.abs(velocity)))
        row += [number_text(effort.velocity_limit), number_text(fastest)]
        if effort.velocity_limit:
            bar['peak speed'] = fastest / effort.velocity_limit
            row.append(_percent(bar['peak speed']))
        else:
            row.append('–')
        power = values * velocity
        exists = np.isfinite(power)
        driving = np.sum(load.weights[exists] * np.maximum(power[exists], 0)) / np.sum(load.weights[exists])
        return row + [number_text(float(np.nanmax(np.abs(power)))), number_text(float(driving))], bar

    def _deviations(self):
        rows = []
        for part in self.parts:
            deviation, load = doubting.deviation_of(self.table, part), self.loads.get(part, 'effort')
            if deviation is None or load is None or load.peak is None:
                continue
            exists = np.isfinite(deviation) & (load.weights > 0)
            if not np.any(exists):
                continue
            rms = weighted_rms(deviation[exists], load.weights[exists])
            rows.append([part.name, part.effort.effort_unit, number_text(load.rms), number_text(rms),
                         _percent(rms / load.rms) if load.rms else '–',
                         number_text(float(deviation[load.peak_row]))])
        if not rows:
            return []
        return [Heading(3, 'Standard deviations of efforts'),
                Table(['', 'in', 'rms effort', 'rms deviation', 'part of it', 'deviation at the peak'], rows, 2)]

    def _doubts(self):
        blocks = [Heading(2, 'Rows to distrust')]
        if not self.doubts:
            return blocks + [Text('None is marked: every value exists, and no column says that it is uncertain. '
                                  'Results are as good as motion and description are.', 'good')]
        items = ['%s: %d of %d rows, %s.' % (doubt.words, np.sum(doubt.rows), len(self.table),
                                             doubting.spans(doubt.rows, self.table.times))
                 for doubt in self.doubts]
        return blocks + [Text('They count in all figures that they have values for, and are shaded in pictures.'),
                         Items(items)]

    def _postures(self):
        columns = [name for name in state_columns(self.table) if name.startswith('position.')]
        if not columns:
            return []
        rows = []
        for part in self.parts:
            for name in POSTURES:
                load = self.loads.get(part, name)
                if not self.loads.matters(load) or (name == 'moment' and part.quantity('tilting_moment')):
                    continue
                state = [number_text(float(self.table.columns[c][load.peak_row])) for c in columns]
                rows.append([part.name, load.quantity.words, '%s %s' % (self._peak_text(load), load.quantity.unit),
                             number_text(load.peak_time, 5)] + state)
        header = ['', 'largest', 'value', 'time, s'] + [c[len('position.'):] for c in columns]
        return [Heading(2, 'Worst postures'),
                Text('Positions of all joints, in rad or m, at the instants of the largest loads. '
                     '`loads.csv` has their velocities, too, and those of all other peaks.'),
                Table(header, rows, 2)]

    # --- joint by joint ------------------------------------------------------------------------------

    def _parts(self):
        blocks = [Heading(2, 'Joint by joint')]
        progress = self.progress.named('drawing')
        for i, part in enumerate(self.parts):
            blocks += [Heading(3, part.name)] + self._part_text(part) + [self._part_table(part)]
            blocks += self._part_figures(part)
            progress.update(i + 1, len(self.parts))
        return blocks

    def _part_text(self, part):
        reaction, texts = part.reaction, []
        if reaction is not None and reaction.moment_elsewhere:
            texts.append('The scene reports its moments about a point of its own, not about the joint.')
        if reaction is not None and reaction.kind == 'closure' and part.turning is None:
            texts.append('How it turns is not among the results, so it has no equivalent bearing load.')
        elif part.turning is not None and not np.any(part.turning):
            texts.append('It does not turn, so it has no equivalent bearing load.')
        return [Text(' '.join(texts), 'note')] if texts else []

    def _part_table(self, part):
        rows = []
        for quantity in part.quantities:
            load = self.loads.get(part, quantity.name)
            numbers = [load.mean, load.rms] + load.percentiles + [load.ball, load.roller,
                                                                     load.range_once, load.range]
            rows.append([quantity.words, quantity.unit, self._peak_text(load), number_text(load.peak_time, 5)]
                        + [self._text(load, number) for number in numbers]
                        + [number_text(load.cycles if self.loads.matters(load) else None)])
        header = ['', 'in', 'peak', 'at, s', 'mean', 'rms', '1 %', '5 %', 'median', '95 %', '99 %',
                  'equivalent, ball', 'equivalent, roller', 'damage: range of one cycle', 'range of N cycles', 'N']
        return _without_empty(header, rows, 2)

    def _part_figures(self, part):
        from vwd_loads import plots
        name = part.name
        figures = []
        drawn = [quantity for row in plots.history_rows(self.loads, part) for quantity in row]
        if drawn:
            doubted = {quantity: self.doubted[name, quantity] for quantity in drawn}
            shaded = '; rows to distrust are shaded' if any(map(np.any, doubted.values())) else ''
            path = plots.history(self.loads, part, doubted, self._figure_path(name, 'history'))
            figures.append(Figure(path, '%s over time%s.' % (name, shaded)))
        effort = self.loads.get(part, 'effort')
        if effort is not None and part.velocity is not None and np.any(part.velocity) and effort.peak is not None:
            limits = ', the limits of the description dashed' if (
                part.effort.effort_limit or part.effort.velocity_limit) else ''
            figures.append(Figure(plots.motor_chart(part, self._figure_path(name, 'motor')),
                                  '%s: effort against speed%s.' % (name, limits), half=True))
        drawn = self._spectra(part)
        if drawn:
            figures.append(Figure(plots.spectra(drawn, self._figure_path(name, 'spectrum')),
                                  '%s: power spectral density.' % name, half=True))
        counted = [self.loads.get(part, quantity) for quantity in COUNTED]
        counted = [load for load in counted if self.loads.matters(load) and load.range]
        if counted and counted[0] is effort:  # a component along the axis may be the same
            counted = [effort] + [load for load in counted[1:] if load.range != effort.range]
        if counted:
            figures.append(Figure(plots.cycles(counted, self._figure_path(name, 'cycles')),
                                  '%s: ranges of cycles by rainflow count.' % name, half=True))
        return figures

    def _spectra(self, part):
        drawn = []
        for words, unit, names in (('effort', None, ['effort']), ('force', 'N', ['fx', 'fy', 'fz']),
                                   ('moment', 'N m', ['tx', 'ty', 'tz'])):
            loads = [self.loads.get(part, name) for name in names]
            if any(load is None or load.peak is None for load in loads) or not any(map(self.loads.matters, loads)):
                continue
            exists = np.all([np.isfinite(load.quantity.values) for load in loads], axis=0)
            pieces = pieces_of(self.table.times, exists, self.loads.gap)
            density = spectra.density_of([load.quantity.values for load in loads], self.table.times, pieces,
                                         self.clock)
            self.short_spectra |= density is None or density.used < 0.95
            variance = sum(load.rms ** 2 for load in loads)
            if density is not None and np.max(density.density) > ROUNDED * variance:
                drawn.append((words, unit or loads[0].quantity.unit, density))
        return drawn


def _without_empty(header, rows, names):
    """A table without columns that hold nothing."""
    keep = [i for i in range(len(header)) if i < names or any(row[i] != '–' for row in rows)]
    return Table([header[i] for i in keep], [[row[i] for i in keep] for row in rows], names)


def _percent(part):
    return number_text(100 * part, 3) + ' %'
