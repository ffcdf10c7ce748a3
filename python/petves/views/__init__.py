"""Views of runs: pictures, films, reports, comparisons."""
