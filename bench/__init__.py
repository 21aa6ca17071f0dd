"""Benchmarks of evo-run: `python3 -m bench --help`."""
