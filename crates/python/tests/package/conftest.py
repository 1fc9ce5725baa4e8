"""What tests of the package share."""

import corpuscle as cp
import pytest


@pytest.fixture
def gas():
    """A small gas whose speeds settle within a second of wall-clock time."""
    return cp.Scene("gas/maxwell", **{"run.until_s": 2.0, "gas.species.0.count": 200, "gas.follow": 0})


@pytest.fixture
def flood():
    """The head of a flood, coarse."""
    return cp.Scene("flood/valley", **{"run.until_s": 60.0, "flood.spacing_m": 16.0})
