"""Checks of the source tree that no compiler makes. Run all of them with scripts/check.py."""
