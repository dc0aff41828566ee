#!/usr/bin/python3
"""Makes estimator.md and its plots from FOLDER/estimator.csv, which estimator_error has written;
scripts/report.sh calls it.
"""
import pathlib
import sys

import estimator_data as ed
import estimator_plots as plots
import estimator_text as text
from page_program import progress, run

CSV = 'estimator.csv'
PAGE = 'estimator.md'
PLOTS = {  # place in the template: file, what draws it
    'window': ('estimator_window.png', plots.over_window),
    'heat': ('estimator_heat.png', plots.heat_maps),
    'trade_off': ('estimator_trade_off.png', plots.trade_off),
    'streams': ('estimator_streams.png', plots.velocities_and_stamps),
}
TEMPLATE = pathlib.Path(__file__).resolve().parent / 'estimator_template.md'


def page(data):
    realistic = data.realistic()
    size = data.size(ed.USUAL_MOTION)
    return TEMPLATE.read_text(encoding='utf-8').format(
        short=text.short_version(data),
        extent=text.extent(data),
        motions=text.motions_table(data),
        encoders=text.encoders_table(data),
        jitter='50 µs',
        grid=text.grid_text(data),
        usual=ed.USUAL_MOTION,
        acceleration=plots.brief(size.qdd_rms_rad_s2),
        efforts=text.best_table(data, ed.USUAL_MOTION, 'none', 'true'),
        accelerations=text.acceleration_table(data),
        folded=text.folded_tables(data),
        velocities=text.velocities_table(data),
        count=len(realistic),
        kinds=text.kinds_text(realistic),
        negligible='%g' % (100 * ed.NEGLIGIBLE),
        poor=text.POOR,
        verdict=text.verdict(data),
        recommended=text.recommended_table(data),
        orders=text.orders_table(data),
        now=text.now_table(data),
        rows='{:,}'.format(data.row_count),
        **{place: file for place, (file, _) in PLOTS.items()})


def write(folder):
    progress('reading ' + CSV)
    data = ed.EstimatorErrors(folder / CSV)
    for file, draw in PLOTS.values():
        progress('drawing ' + file)
        draw(data, folder / file)
    progress('writing ' + PAGE)
    (folder / PAGE).write_text(page(data), encoding='utf-8')
    progress(None)


if __name__ == '__main__':
    sys.exit(run('estimator_page.py', __doc__, lambda arguments: write(arguments.folder)))
