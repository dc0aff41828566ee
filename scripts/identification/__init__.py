"""What identify.py is made of: recordings, filters, regression, bodies, results."""
