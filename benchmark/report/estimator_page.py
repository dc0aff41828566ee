#!/usr/bin/python3
"""Makes estimator.md and its plots from FOLDER/estimator.csv, and estimator_long_run.csv where it
is there, which estimator_error has written; scripts/report.sh calls it.
"""
import pathlib
import sys

import estimator_data as ed
import estimator_plots as plots
import estimator_text as text
from page_program import progress, run

CSV = 'estimator.csv'
LONG_RUN = 'estimator_long_run.csv'
PAGE = 'estimator.md'
PLOTS = {
    'estimator_ratios.png': plots.ratios,
    'estimator_lags.png': plots.lags,
    'estimator_calibration.png': plots.calibration,
    'estimator_recording.png': plots.recording,
}
TEMPLATE = pathlib.Path(__file__).resolve().parent / 'estimator_template.md'


def page(figures, long_run):
    words = TEMPLATE.read_text(encoding='utf-8')
    if not text.recording_rows(figures):
        words = words.replace('![Explained variance](estimator_recording.png)\n\n', '')
    return words.format(
        short=text.short_version(figures),
        extent=text.extent(figures),
        methods=text.methods_table(figures),
        groups=text.groups_table(figures),
        beyond=text.beyond_table(figures),
        streams=text.streams_table(figures),
        node=text.node_table(figures),
        wrong=text.wrong_table(figures),
        calibration=text.calibration_table(figures),
        recording=text.recording_table(figures),
        time=text.time_table(figures),
        long_run=text.long_run_text(long_run),
        rows='{:,}'.format(figures.row_count))


def write(folder):
    progress('reading ' + CSV)
    figures = ed.EstimatorFigures(folder / CSV)
    long_run = None
    if (folder / LONG_RUN).is_file():
        long_run = ed.EstimatorFigures(folder / LONG_RUN, 'long_run')
    for file, draw in PLOTS.items():
        progress('drawing ' + file)
        draw(figures, folder / file)
    progress('writing ' + PAGE)
    (folder / PAGE).write_text(page(figures, long_run), encoding='utf-8')
    progress(None)


if __name__ == '__main__':
    sys.exit(run('estimator_page.py', __doc__, lambda arguments: write(arguments.folder)))
