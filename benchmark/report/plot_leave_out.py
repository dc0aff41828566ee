"""Operations and run time of plans that leave something out, one row of bars for each."""
import textwrap

import markdown_text
from plot_style import BLUE, ORANGE, SKY, new_figure, save

WIDTH = 11.5  # inches
BAR = 0.33  # inches for each plan
HEAD = 1.1  # inches for a scene's title and axis
NAME_WIDTH = 44  # letters


def _bars(axes, rows):
    """Multiplications and additions one after the other, with their sum."""
    places = range(len(rows))
    multiplications = [row.multiplications for row in rows]
    additions = [row.additions for row in rows]
    axes.barh(places, multiplications, color=BLUE, height=0.68, label='multiplications')
    axes.barh(places, additions, left=multiplications, color=SKY, height=0.68, label='additions')
    most = max(m + a for m, a in zip(multiplications, additions))
    for i, (m, a) in enumerate(zip(multiplications, additions)):
        axes.text(m + a + 0.012 * most, i, '{:,}'.format(m + a), va='center', fontsize=9)
    axes.set_xlim(0, 1.14 * most)
    axes.set_xlabel('operations per sample')


def _times(axes, rows):
    most = max(row.ns for row in rows)
    axes.barh(range(len(rows)), [row.ns for row in rows], color=ORANGE, height=0.68)
    for i, row in enumerate(rows):
        axes.text(row.ns + 0.012 * most, i, markdown_text.ns(row.ns), va='center', fontsize=9)
    axes.set_xlim(0, 1.14 * most)
    axes.set_xlabel('run time [ns per sample]')


def plot_leave_out(data, titles, path):
    """titles: a scene's name for readers."""
    scenes = [(scene, data.of_scene(scene)) for scene in data.scenes]
    heights = [HEAD + BAR * len(rows) for _, rows in scenes]
    figure, grid = new_figure((WIDTH, sum(heights) + 0.3), rows=len(scenes), columns=2,
                              sharey='row', squeeze=False,
                              gridspec_kw={'height_ratios': heights})
    figure.get_layout_engine().set(w_pad=0.08, h_pad=0.1)
    for (scene, rows), (left, right) in zip(scenes, grid):
        _bars(left, rows)
        _times(right, rows)
        left.set_yticks(range(len(rows)))
        left.set_yticklabels([textwrap.fill(row.left_out, NAME_WIDTH) for row in rows])
        left.set_ylim(len(rows) - 0.4, -0.6)
        left.set_title('%s: left out' % titles(scene), x=0, ha='left')
        for axes in (left, right):
            axes.grid(axis='y', visible=False)
    handles, names = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, names, loc='upper right', ncol=2)
    save(figure, path)
