"""The studies behind docs/: every table and picture there, made again by ``python3 -m studies``."""
