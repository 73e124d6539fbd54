"""A plugin of pytest: no file of tests finds a result that a cache of ours kept for another, so it
passes the lines that make what it looks at."""

import functools
import gc

_seen = []


def pytest_runtest_setup(item):
    """Before a file's first test."""
    if _seen[-1:] != [item.path]:
        _seen.append(item.path)
        for kept in gc.get_objects():
            if isinstance(kept, functools._lru_cache_wrapper):
                if str(getattr(kept, "__module__", "")).startswith("seethrough."):
                    kept.cache_clear()
