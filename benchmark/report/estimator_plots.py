"""Plots of the estimator's page."""
import collections

from plot_style import FAINT, INK, SERIES_COLORS, SERIES_MARKERS, new_figure, save
from matplotlib.colors import LogNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

import estimator_data as ed

SIZE = (11.0, 7.4)  # inches
LAGS = (0, 2, 8, 32)  # samples, of the lines over the window; and the middle
HEAT_LAGS = (0, 1, 2, 4, 8, 16, 32)
TRADE_OFF_TICKS = (0, 2, 4, 8, 16, 32, 64, 128)  # ms
ENCODER_NAMES = {
    'exact': 'exact',
    'magnetic_12bit_joint': '12 bit magnetic at the joint',
    'magnetic_12bit_motor': '12 bit magnetic at the motor, 1:100',
    'optical_20bit_joint': '20 bit optical at the joint',
    'servo_17bit_motor': '17 bit servo motor, 1:100',
    'servo_20bit_motor': '20 bit servo motor, 1:100',
}


def encoder_name(encoder):
    return ENCODER_NAMES.get(encoder, encoder.replace('_', ' '))


def brief(value):
    """Two digits."""
    return '%.2g' % value if value < 99.5 else '%.0f' % value


def percent(share):
    return brief(100 * share)


def plain(value):
    return '%g' % value


def _plain_ticks(axis, values):
    axis.set_major_locator(FixedLocator(values))
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    axis.set_minor_locator(NullLocator())


def _lines_over_window(axes, rows, value, x):
    """One line for each lag of LAGS, and one for the middle."""
    for i, lag in enumerate(LAGS):
        of_lag = [row for row in rows if row.setting.lag == lag]
        axes.plot([x(row) for row in of_lag], [value(row) for row in of_lag],
                  color=SERIES_COLORS[i], marker=SERIES_MARKERS[i], markersize=4.5)
    centred = [row for row in rows if ed.middle(row.setting)]
    axes.plot([x(row) for row in centred], [value(row) for row in centred], color=INK,
              marker='P', markersize=5)


def _spread_out(rows):
    """Settings whose windows lie far enough apart for a tick each."""
    chosen = []
    for setting in sorted({row.setting for row in rows}):
        if not chosen or setting.window - 1 >= 1.9 * (chosen[-1].window - 1):
            chosen.append(setting)
    return chosen


def _window_legend():
    lags = [Line2D([], [], color=SERIES_COLORS[i], marker=SERIES_MARKERS[i], markersize=5,
                   label='lag %d' % lag) for i, lag in enumerate(LAGS)]
    return lags + [
        Line2D([], [], color=INK, marker='P', markersize=5, label='middle of the window'),
        Line2D([], [], color=INK, linestyle=':', label='reading noise alone, middle, by formula'),
        Line2D([], [], color=FAINT, linestyle='--', label='the acceleration itself, RMS'),
        Line2D([], [], color='none', marker='*', markersize=12, markerfacecolor='gold',
               markeredgecolor=INK, label='default settings')]


def over_window(data, path):
    """Error of the acceleration over the window, one panel for each encoder."""
    rate, order = data.rates[-1], data.default.order
    figure, grid = new_figure(SIZE, 2, 3, sharex=True, sharey=True)
    size = data.size(ed.USUAL_MOTION)
    for axes, encoder in zip(grid.flat, data.encoders):
        stream = ed.Stream(rate, ed.USUAL_MOTION, encoder, 'none', 'true')
        rows = [row for row in data.grid(stream).values() if row.setting.order == order]
        rows.sort(key=lambda row: row.setting.window)
        _lines_over_window(axes, rows, lambda row: row.qdd_rms_rad_s2,
                           lambda row: ed.length(row.setting, rate))
        windows = sorted({row.setting.window for row in rows})
        if data.encoders[encoder].counts:
            axes.plot([1000.0 * (w - 1) / rate for w in windows],
                      [ed.noise_formula(data.encoders[encoder], w, rate) for w in windows],
                      color=INK, linestyle=':')
        axes.axhline(size.qdd_rms_rad_s2, color=FAINT, linestyle='--', linewidth=1.2)
        default = data.find(stream, ed.DEFAULT)
        axes.plot(ed.length(default.setting, rate), default.qdd_rms_rad_s2, marker='*',
                  markersize=13, markerfacecolor='gold', markeredgecolor=INK, zorder=5)
        axes.set_title(encoder_name(encoder), fontsize=10.5)
        axes.set_xscale('log')
        axes.set_yscale('log')
        _plain_ticks(axes.xaxis, [ed.length(s, rate) for s in _spread_out(rows)])
    grid[0, 0].set_ylim(1e-5, 1e4)
    for axes in grid[-1]:
        axes.set_xlabel('length of the window, ms')
    for axes in grid[:, 0]:
        axes.set_ylabel('RMS error of acceleration, rad/s²')
    _finish(figure, 'Acceleration error over window: %d Hz, %s motion, no velocities, order %d' % (
        rate, ed.USUAL_MOTION, order), _window_legend(), path)


def _finish(figure, title, handles, path, columns=4):
    """A title above all panels and a legend below them."""
    figure.suptitle(title, x=0.01, ha='left', weight='bold', fontsize=12.5)
    figure.canvas.draw()  # lays the panels out, which then make room
    figure.set_constrained_layout(False)
    rows = -(-len(handles) // columns)
    room = (0.25 * rows + 0.15) / figure.get_figheight()
    for axes in figure.axes:
        box = axes.get_position()
        axes.set_position([box.x0, room + box.y0 * (1 - room), box.width,
                           box.height * (1 - room)])
    figure.legend(handles=handles, loc='lower center', ncol=columns)
    save(figure, path)


def _envelope(rows):
    """[(delay, row)]: for each delay the least error with no more delay."""
    by_delay = collections.defaultdict(list)
    for row in rows:
        by_delay[ed.delay(row)].append(row)
    found, best = [], None
    for time in sorted(by_delay):
        least = min(by_delay[time], key=lambda row: row.effort_rms_share)
        if best is None or least.effort_rms_share < best.effort_rms_share:
            best = least
        found.append((time, best))
    return found


def trade_off(data, path):
    """Least error of the effort over the delay, one panel for each rate."""
    columns = 2
    figure, grid = new_figure(SIZE, -(-len(data.rates) // columns), columns, sharex=True,
                              sharey=True, squeeze=False)
    handles = []
    for axes, rate in zip(grid.flat, data.rates):
        handles = []
        encoders = [e for e in data.encoders if e != ed.EXACT_ENCODER]
        for encoder, color, marker in zip(encoders, SERIES_COLORS, SERIES_MARKERS):
            stream = ed.Stream(rate, ed.USUAL_MOTION, encoder, 'none', 'true')
            found = [(time, row) for time, row in _envelope(data.grid(stream).values())
                     if time <= TRADE_OFF_TICKS[-1]]
            axes.plot([time for time, _ in found],
                      [100 * row.effort_rms_share for _, row in found], color=color,
                      marker=marker, markersize=4.5)
            for method, symbol, size in ((ed.DEFAULT, '*', 13), (ed.DIFFERENCES, 'X', 8)):
                row = data.find(stream, method)
                axes.plot(ed.delay(row), 100 * row.effort_rms_share, marker=symbol,
                          markersize=size, markerfacecolor=color, markeredgecolor=INK, zorder=5)
            handles.append(Line2D([], [], color=color, marker=marker, markersize=5,
                                  label=encoder_name(encoder)))
        axes.set_title('%d Hz' % rate, fontsize=10.5)
        axes.set_yscale('log')
        axes.set_xscale('symlog', linthresh=4)
        axes.set_xlim(-0.4, 1.1 * TRADE_OFF_TICKS[-1])
        _plain_ticks(axes.xaxis, TRADE_OFF_TICKS)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    for axes in grid[-1]:
        axes.set_xlabel('delay of the result, ms')
    for axes in grid[:, 0]:
        axes.set_ylabel('RMS error of effort, % of its range')
    handles += [Line2D([], [], color='none', marker=symbol, markersize=size, markeredgecolor=INK,
                       markerfacecolor='white', label=name)
                for symbol, size, name in (('*', 13, 'default settings'),
                                           ('X', 8, 'positions differenced twice'))]
    _finish(figure, 'What delay buys: least effort error with that delay or less, %s motion, '
            'no velocities' % ed.USUAL_MOTION, handles, path)


def _heat_cells(data, stream, windows, lags):
    """Rows of errors; the last one is of the middle lag. None: no such setting."""
    rows = data.grid(stream)
    cells = []
    for lag in lags + (None,):
        line = []
        for window in windows:
            at = (window - 1) // 2 if lag is None else lag
            found = rows.get(ed.Setting(window, data.default.order, at))
            line.append(found.effort_rms_share if found and at <= (window - 1) // 2 else None)
        cells.append(line)
    return cells


def _heat_panel(axes, cells, norm):
    shown = [[float('nan') if cell is None else 100 * cell for cell in line] for line in cells]
    image = axes.imshow(shown, norm=norm, cmap='viridis_r', aspect='auto')
    least = min(cell for line in cells for cell in line if cell is not None)
    for y, line in enumerate(cells):
        for x, cell in enumerate(line):
            if cell is None:
                continue
            dark = norm(100 * cell) > 0.5
            axes.text(x, y, percent(cell), ha='center', va='center', fontsize=7.5,
                      color='white' if dark else INK,
                      weight='bold' if cell == least else 'normal')
    axes.grid(False)
    return image


def _frame(axes, x, y):
    axes.add_patch(Rectangle((x - 0.5, y - 0.5), 1, 1, fill=False, edgecolor='gold', linewidth=2.5))


def heat_maps(data, path):
    """Effort error over window and lag, one panel for each of four encoders."""
    rate, order = data.rates[-1], data.default.order
    encoders = [e for e in data.encoders if e != ed.EXACT_ENCODER][:4]
    first = data.grid(ed.Stream(rate, ed.USUAL_MOTION, encoders[0], 'none', 'true'))
    windows = sorted({s.window for s in first if s.order == order})
    panels = {e: _heat_cells(data, ed.Stream(rate, ed.USUAL_MOTION, e, 'none', 'true'), windows,
                             HEAT_LAGS) for e in encoders}
    values = [100 * cell for cells in panels.values() for line in cells for cell in line
              if cell is not None]
    norm = LogNorm(min(values), max(values))
    figure, grid = new_figure(SIZE, 2, 2, sharex=True, sharey=True)
    for axes, encoder in zip(grid.flat, encoders):
        image = _heat_panel(axes, panels[encoder], norm)
        axes.set_title(encoder_name(encoder), fontsize=10.5)
        if data.default.window in windows and data.default.lag in HEAT_LAGS:
            _frame(axes, windows.index(data.default.window), HEAT_LAGS.index(data.default.lag))
        axes.set_xticks(range(len(windows)))
        axes.set_xticklabels([str(w) for w in windows])
        axes.set_yticks(range(len(HEAT_LAGS) + 1))
        axes.set_yticklabels([str(lag) for lag in HEAT_LAGS] + ['middle'])
    for axes in grid[-1]:
        axes.set_xlabel('window, samples')
    for axes in grid[:, 0]:
        axes.set_ylabel('lag, samples')
    bar = figure.colorbar(image, ax=grid.ravel().tolist(), shrink=0.8)
    bar.set_label('RMS error of effort, % of its range')
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    figure.suptitle('Effort error over window and lag: %d Hz, %s motion, no velocities, order %d\n'
                    'bold: least, framed: default settings' % (rate, ed.USUAL_MOTION, order),
                    x=0.01, ha='left', weight='bold', fontsize=12.5)
    save(figure, path)


def _compared(axes, data, streams, order):
    # Lines that coincide show each other's markers.
    styles = zip(SERIES_COLORS, ('o', 's', '^'), (10, 7, 4))
    for (name, stream), (color, marker, size) in zip(streams, styles):
        rows = sorted((row for row in data.grid(stream).values() if row.setting.order == order
                       and ed.middle(row.setting)), key=lambda row: row.setting.window)
        axes.plot([ed.length(row.setting, stream.rate) for row in rows],
                  [100 * row.effort_rms_share for row in rows], color=color, marker=marker,
                  markersize=size, markerfacecolor='white' if size > 5 else color, label=name)
    axes.set_xscale('log')
    axes.set_yscale('log')
    lengths = [ed.length(row.setting, stream.rate) for row in rows]
    _plain_ticks(axes.xaxis, [2 ** n for n in range(12)
                              if lengths[0] <= 2 ** n <= 1.1 * lengths[-1]])
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain(value)))
    axes.legend(loc='best')


def velocities_and_stamps(data, path):
    """Effort error over window: by source of the velocities, and by quality of the stamps."""
    order, encoder = data.default.order, ed.VARIED_ENCODER
    rates = [data.rates[0], data.rates[-1]]
    figure, grid = new_figure(SIZE, 2, 2, sharey='row')
    for line, rate in zip(grid, rates):
        velocities = [(name, ed.Stream(rate, ed.USUAL_MOTION, encoder, source, 'true'))
                      for source, name in (('none', 'no velocities'),
                                           ('differences', 'differences of positions'),
                                           ('exact', 'exact velocities'))]
        stamps = [(name, ed.Stream(rate, ed.USUAL_MOTION, encoder, 'none', kind))
                  for kind, name in (('true', 'even sampling, true stamps'),
                                     ('uneven', 'uneven sampling (50 µs), true stamps'),
                                     ('wrong', 'even sampling, stamps wrong by 50 µs'))]
        _compared(line[0], data, velocities, order)
        _compared(line[1], data, stamps, order)
        line[0].set_title('%d Hz: velocities' % rate, fontsize=10.5)
        line[1].set_title('%d Hz: stamps, no velocities' % rate, fontsize=10.5)
        line[0].set_ylabel('RMS error of effort, % of its range')
    for axes in grid[-1]:
        axes.set_xlabel('length of the window, ms')
    figure.suptitle('Velocities and stamps: %s, %s motion, order %d, middle of the window' % (
        encoder_name(encoder), ed.USUAL_MOTION, order), x=0.01, ha='left', weight='bold',
        fontsize=12.5)
    save(figure, path)
