"""Cases drawn at random from a fixed seed (tests/robustness/fuzz.py): numbers, words, files, environment, signals."""

from collections import Counter

import fuzz

SEED = 2024
CASES = 300
RANKS = [1] * 9 + [2]


def test_random_cases_end_well(tmp_path):
    wrong, cases = fuzz.run_cases(SEED, list(range(CASES)), RANKS, tmp_path)
    assert not wrong, f"seed {SEED}: {len(wrong)} of {CASES}\n" + "\n".join(wrong)
    good = sum((tmp_path / f"case{k}" / "out" / "summary.json").exists() for k in range(CASES))
    assert CASES / 10 < good < CASES, "both kinds were drawn"
    kinds = Counter(case.kind for case in cases)
    assert min(kinds[kind] for kind in ("numbers", "words", "option file", "curve", "checkpoint", "environment")) > 5
    assert kinds["signal"] > 0
