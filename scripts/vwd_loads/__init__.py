"""Load report: what results of inverse_dynamics_offline mean for bearings, flanges and motors.

table        reads results; NaN is a value that does not exist
mechanism    what the columns belong to: joints, axes, limits
pieces       rows in one go, without gaps, and the time that each row stands for
statistics   peaks, means and percentiles over time
bearings     forces along and across an axis, equivalent load (ISO 281)
rainflow     cycles (ASTM E1049) and the damage-equivalent range
spectrum     power spectral density
quantities   the time series of each joint and closure
loads        all figures of all quantities: loads.csv, sums.json
doubts       rows that are not to be trusted
plots        pictures
document     headings, texts, tables and pictures as Markdown or as one HTML page
report       the report of one motion
merged       the report of many
command      the command line
"""
