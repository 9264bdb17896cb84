"""The suites of scripts/benchmark: scans with known truth, how they are run, measured and reported."""
