#!/usr/bin/python3
"""The figures of a load report against published counts, formulas and cases worked out by hand."""
import pathlib
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from vwd_loads import bearings, rainflow, spectrum, statistics  # noqa: E402 (the path has to be set first)
from vwd_loads.pieces import gap_length, pieces_of, weights_of  # noqa: E402
from vwd_loads.plots import history_rows  # noqa: E402
from vwd_loads.quantities import Quantity  # noqa: E402

# ASTM E1049-85, example of the rainflow count: figure X1.6 and its table.
PUBLISHED_SERIES = (-2, 1, -3, 5, -1, 3, -4, 4, -2)
PUBLISHED_COUNTS = {3: 0.5, 4: 1.5, 6: 0.5, 8: 1.0, 9: 0.5}
ROUNDING = 1e-12  # some hundred operations


def summed(ranges, counts):
    totals = {}
    for size, count in zip(ranges, counts):
        totals[float(size)] = totals.get(float(size), 0) + count
    return totals


class Rainflow(unittest.TestCase):
    def test_counts_the_published_series(self):
        self.assertEqual(summed(*rainflow.count_cycles(PUBLISHED_SERIES)), PUBLISHED_COUNTS)

    def test_counts_it_alike_upside_down_and_with_points_between(self):
        self.assertEqual(summed(*rainflow.count_cycles([-x for x in PUBLISHED_SERIES])), PUBLISHED_COUNTS)
        between = []
        for a, b in zip(PUBLISHED_SERIES, PUBLISHED_SERIES[1:]):
            between += [a, a, 0.7 * a + 0.3 * b, b]
        self.assertEqual(summed(*rainflow.count_cycles(between)), PUBLISHED_COUNTS)

    def test_every_way_between_turns_is_counted_once(self):
        random = np.random.default_rng(1)
        for _ in range(50):
            series = random.normal(size=random.integers(2, 200))
            ranges, counts = rainflow.count_cycles(series)
            self.assertAlmostEqual(float(np.sum(2 * counts * ranges)), float(np.sum(np.abs(np.diff(series)))),
                                   delta=1e-10)
            self.assertAlmostEqual(float(np.max(ranges)), float(np.ptp(series)), delta=1e-14)

    def test_what_does_not_change_has_no_cycles(self):
        for series in ([], [3.0], [2.0] * 5):
            self.assertEqual(len(rainflow.count_cycles(series)[0]), 0)

    def test_no_cycle_reaches_across_a_gap(self):
        series = np.array([0, 5, 0, np.nan, 100, 101, 100.0])
        pieces = pieces_of(np.arange(7.0), np.isfinite(series), 2.0)
        self.assertEqual(summed(*rainflow.count_pieces(series, pieces)), {5.0: 1.0, 1.0: 1.0})

    def test_equivalent_range_by_hand(self):
        # 100 cycles of 2 and 1 of 10 at m = 3: damage 800 + 1000.
        ranges, counts = np.array([2.0, 10.0]), np.array([100.0, 1.0])
        self.assertAlmostEqual(rainflow.range_applied_once(ranges, counts, 3), 1800 ** (1 / 3), delta=ROUNDING * 20)
        self.assertAlmostEqual(rainflow.equivalent_range(ranges, counts, 3), (1800 / 101) ** (1 / 3),
                               delta=ROUNDING * 20)
        self.assertAlmostEqual(rainflow.equivalent_range(np.full(7, 4.0), np.ones(7), 5), 4, delta=ROUNDING * 20)


class Bearings(unittest.TestCase):
    def equivalent(self, load, speed, exponent, count=100001):
        times = np.linspace(0, 1, count)
        return bearings.equivalent_load(load(times), speed(times), times, [slice(0, count)], exponent)

    def test_a_load_that_grows_with_the_angle(self):
        # |F| = t over even travel: P^p = 1 / (p + 1); the trapezoids are off by p / 12 / count^2.
        self.assertAlmostEqual(self.equivalent(lambda t: t, lambda t: 0 * t + 2, bearings.BALL), 0.25 ** (1 / 3),
                               delta=1e-9)
        self.assertAlmostEqual(self.equivalent(lambda t: -t, lambda t: 0 * t - 2, bearings.ROLLER),
                               (3 / 13) ** 0.3, delta=1e-9)

    def test_time_at_rest_does_not_wear(self):
        # 7 N at rest, 1 N while it turns; the row between counts half.
        load, speed = lambda t: np.where(t < 0.5, 7.0, 1.0), lambda t: np.where(t < 0.5, 0.0, 3.0)
        self.assertAlmostEqual(self.equivalent(load, speed, bearings.BALL), 1, delta=1e-12)

    def test_travel_weighs(self):
        # 2 N over a way of 3, 1 N over a way of 1: P^3 = (8 * 3 + 1) / 4.
        times = np.arange(5.0)
        pieces = [slice(0, 2), slice(3, 5)]
        load, speed = np.array([2, 2, 99, 1, 1.0]), np.array([3, 3, 99, 1, 1.0])
        self.assertAlmostEqual(bearings.equivalent_load(load, speed, times, pieces, 3.0), 6.25 ** (1 / 3),
                               delta=ROUNDING)

    def test_what_does_not_turn_has_none(self):
        self.assertIsNone(self.equivalent(lambda t: 1 + t, lambda t: 0 * t, bearings.BALL))

    def test_parts_along_and_across_an_axis_by_hand(self):
        moments = np.array([[3.0, 4.0, 5.0], [0.0, 0.0, -2.0]])
        z = np.array([0.0, 0.0, 1.0])
        self.assertEqual(bearings.across(moments, z).tolist(), [5.0, 0.0])
        self.assertEqual(bearings.along(moments, z).tolist(), [5.0, -2.0])
        oblique = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)
        self.assertAlmostEqual(bearings.across(np.array([[1.0, 0, 0]]), oblique)[0], np.sqrt(2 / 3), delta=ROUNDING)
        self.assertAlmostEqual(bearings.along(np.array([[1.0, 0, 0]]), oblique)[0], np.sqrt(1 / 3), delta=ROUNDING)


class Statistics(unittest.TestCase):
    def test_rows_count_by_their_time(self):
        # 1 for a second at 1 kHz, 0 for a second at 10 Hz.
        times = np.concatenate((np.arange(1000) / 1000, 1 + np.arange(11) / 10))
        values = np.concatenate((np.ones(1000), np.zeros(11)))
        pieces = pieces_of(times, np.ones(len(times), bool), 0.25)
        weights = weights_of(times, pieces)
        half_step = 0.0005 / 2
        self.assertAlmostEqual(statistics.weighted_mean(values, weights), 0.5, delta=half_step)
        self.assertAlmostEqual(statistics.weighted_rms(values, weights), np.sqrt(0.5), delta=half_step)
        self.assertEqual(statistics.weighted_percentiles(values, weights, (49, 51)), [0.0, 1.0])

    def test_gaps_have_no_time(self):
        times = np.array([0, 0.1, 0.2, 5.0, 5.1])
        gap = gap_length(times, 0.25)
        self.assertAlmostEqual(gap, 0.5)  # five usual spacings
        pieces = pieces_of(times, np.ones(5, bool), gap)
        self.assertEqual([(p.start, p.stop) for p in pieces], [(0, 3), (3, 5)])
        np.testing.assert_allclose(weights_of(times, pieces), [0.05, 0.1, 0.05, 0.05, 0.05], atol=1e-12)

    def test_rows_that_lack_a_value_split_pieces(self):
        exists = np.array([False, True, True, False, True, False])
        pieces = pieces_of(np.arange(6.0), exists, 2.0)
        self.assertEqual([(p.start, p.stop) for p in pieces], [(1, 3), (4, 5)])


class Spectra(unittest.TestCase):
    RATE, AMPLITUDE, FREQUENCY = 500.0, 2.0, 12.5

    def sine(self, times):
        return 3 + self.AMPLITUDE * np.sin(2 * np.pi * self.FREQUENCY * times)

    def check(self, times, values, pieces, power_error):
        clock = spectrum.Clock(times, 0.25)
        found = spectrum.density_of([values], times, pieces, clock)
        step = found.frequencies[1] - found.frequencies[0]
        self.assertAlmostEqual(found.frequencies[np.argmax(found.density)], self.FREQUENCY, delta=step)
        power = np.sum(found.density) * step
        self.assertAlmostEqual(power, self.AMPLITUDE ** 2 / 2, delta=power_error)
        return clock, found

    def test_a_sine_has_its_frequency_and_power(self):
        times = np.arange(10000) / self.RATE
        clock, found = self.check(times, self.sine(times), [slice(0, 10000)], 0.01)
        self.assertTrue(clock.even)
        self.assertAlmostEqual(clock.rate, self.RATE, delta=1e-6)
        self.assertEqual(found.used, 1)

    def test_uneven_stamps_are_found_and_brought_to_even_steps(self):
        random = np.random.default_rng(2)
        times = np.cumsum(random.uniform(0.5, 1.5, 10000)) / self.RATE
        clock, _ = self.check(times, self.sine(times), [slice(0, 10000)], 0.05)
        self.assertFalse(clock.even)
        self.assertAlmostEqual(clock.spread, 1 / np.sqrt(12), delta=0.01)

    def test_pieces_do_not_know_each_other(self):
        # The second piece begins at another phase and place, as a jump of 1000 would show.
        times = np.concatenate((np.arange(6000) / self.RATE, 100.003 + np.arange(6000) / self.RATE))
        values = self.sine(times)
        values[6000:] += 1000
        pieces = pieces_of(times, np.ones(12000, bool), 0.25)
        self.check(times, values, pieces, 0.01)

    def test_components_add_up_and_short_pieces_have_none(self):
        times = np.arange(10000) / self.RATE
        clock = spectrum.Clock(times, 0.25)
        one = spectrum.density_of([self.sine(times)], times, [slice(0, 10000)], clock)
        three = spectrum.density_of([self.sine(times)] * 3, times, [slice(0, 10000)], clock)
        np.testing.assert_allclose(three.density, 3 * one.density, rtol=1e-12)
        self.assertIsNone(spectrum.density_of([self.sine(times)], times, [slice(0, 20)], clock))


class Drawn(unittest.TestCase):
    """What a picture over time shows; loads that all matter, of a joint that slides or turns."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.units = {}

    def quantity(self, name):
        return Quantity(name, self.units[name], None, name) if name in self.units else None

    def get(self, _, name):
        return self.quantity(name)

    def matters(self, quantity):
        return quantity is not None

    def test_what_shares_an_axis_has_one_unit(self):
        bearing = {"radial_force": "N", "axial_force": "N", "tilting_moment": "N m"}
        whole = {"force": "N", "moment": "N m"}
        for units in (bearing, whole, dict(bearing, effort="N"), dict(bearing, effort="N m"),
                      dict(whole, effort="N"), dict(whole, effort="N m"), {"effort": "N"}):
            with self.subTest(units=units):
                self.units = units
                rows = history_rows(self, self)
                for row in rows:
                    self.assertEqual(len({units[name] for name in row}), 1, row)
                self.assertEqual(sorted(sum(rows, [])), sorted(units))


if __name__ == "__main__":
    unittest.main()
