"""Trials of made-up people whose values have the published moments."""

from __future__ import annotations

import itertools

import numpy as np

from seethrough.experiment.people.fitted.calibration import LEVELS, published


def values_of(means, sds, r, n=16, seed=1):
    """(n, 2) values whose moments are exactly these."""
    z = np.random.default_rng(seed).standard_normal((n, 2))
    z -= z.mean(axis=0)
    z = z @ np.linalg.inv(np.linalg.cholesky(np.cov(z.T))).T
    z = np.stack([z[:, 0], r * z[:, 0] + (1 - r * r) ** 0.5 * z[:, 1]], axis=1)
    return z * sds + means


def published_rows(errors=True):
    """Trials whose participants' values have the published moments, three each."""
    rows = []
    for task in ("count", "pattern", "unique", "count_in_building"):
        made = {
            what: values_of(m.means, m.sds, m.r or 0.0, seed=len(task))
            for (own, what), m in published().items()
            if own == task
        }
        for (i, k), t in itertools.product(np.ndindex(16, 2), (-1.0, 0.0, 1.0)):
            row = {"task": task, "transparency": LEVELS[k], "participant": f"S{i}",
                   "time": made["time"][i, k] + t}  # fmt: skip
            if "error" in made and errors:
                # Errors of opposite signs: only their sum over the three counts. Shares of 16
                # normal values may be negative; their size is what is measured.
                row |= {"count_error": 10 * made["error"][i, k] + 5 * t, "truth": "10"}
            elif "distance" in made:
                row |= {"distance": made["distance"][i, k] + t}
            elif "correct" in made:
                row |= {"correct": made["correct"][i, k] + t}
            rows.append(row)
    return rows
