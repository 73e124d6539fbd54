"""The tests of a measure: omnibus, contrasts, pairs, ranks."""
