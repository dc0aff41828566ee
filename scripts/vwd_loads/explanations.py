"""How the figures of a report are found, for its last section."""
from vwd_loads.document import Heading, Items, number_text
from vwd_loads.spectrum import EVEN

AXES = {'child': 'axes of the child link', 'root': 'axes of the root link',
        'inertial': 'axes of the inertial frame that the root link moves against'}


def axes_words(axes):
    """In words, the axes that reactions are in; '' where the results do not say it."""
    return AXES.get(axes, 'the axes of the results')


def explanations(loads, clock, short_spectra):
    woehler = number_text(loads.settings.woehler)
    mechanism = loads.mechanism
    elsewhere = any(reaction.moment_elsewhere for reaction in mechanism.reactions)
    items = [
        'Forces and moments are what the parent link exerts on the child link, in %s, moments about the origin of '
        'the joint%s. Of rigid bodies: what a bearing is preloaded with, and what bodies swing by, is not in them.'
        % (axes_words(mechanism.axes), ' or about the point of the scene' if elsewhere else ''),
        'Means, rms and percentiles are over time: a row stands for half of the way to its neighbours. 95 %: '
        'for that part of the time the value is not larger.',
        'Peak: the value of the largest magnitude. Radial: what is normal to the axis of the joint; axial: '
        'along it; tilting moment: the moment normal to it. A pair of bearings takes the tilting moment by '
        'radial forces of their distance, which are not in the radial force.',
        'Equivalent bearing load (ISO 281): P = (∫ |F|^p |ω| dt / ∫ |ω| dt)^(1/p), p = 3 for ball, 10/3 for '
        'roller bearings: the constant load that wears the bearing alike over the same travel. It is of the '
        'magnitude of the whole force; factors X and Y of a bearing are its own, and the same is in '
        '`loads.csv` for radial and axial force and tilting moment.',
        'Cycles: rainflow count of ASTM E1049, halves of cycles included, of each signed component. Damage at the '
        'Wöhler exponent m = %s (3: welded steel, 5 and more: machined steel): the range that does the damage of '
        'all cycles in one, and in as many as were counted, N. Noise makes many small cycles, which hardly '
        'change the first and lower the second; the range of any other number n of cycles is the first over '
        'n^(1/m).' % woehler,
        'Mean driving power: the mean of effort times speed, where it is positive.',
        'Spectra: Welch, Hann windows that overlap by half, means taken out; the integral over frequencies is '
        'the variance. Of a force: the sum over its components. Frequencies beyond the bandwidth of the motion '
        'estimate are those of the estimator, not of the robot.']
    if not clock.even:
        items.append('The spacing of rows varies by %s %% (standard deviation): for spectra alone they are '
                     'brought to even steps by straight lines, which lower the densities towards half of the '
                     'rate of %s Hz.' % (number_text(100 * clock.spread, 2), number_text(clock.rate)))
    else:
        items.append('The spacing of rows varies by less than %.0f %%, so that they count as even for spectra.'
                     % (100 * EVEN))
    if short_spectra:
        items.append('Where gaps leave short pieces, these are not in the spectra, or there is none.')
    return [Heading(2, 'How the figures are found'), Items(items)]
