"""What nobody should give, drawn by hypothesis: the same in every run of the default tier."""

from hypothesis import HealthCheck, settings, strategies as st

FEW = settings(
    derandomize=True, deadline=None, max_examples=60,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)  # fmt: skip
NUMBERS = st.integers(-(2**70), 2**70) | st.floats()
WORDS = st.sampled_from(["", "m", "1 um", "nan", "-1 mm", "hertz", "true", "[]"]) | st.text(max_size=8)


def _inside(values):
    return st.lists(values, max_size=4) | st.dictionaries(WORDS, values, max_size=3)


# Of any kind that TOML and JSON have, and one inside another.
VALUES = st.recursive(st.booleans() | NUMBERS | WORDS, _inside, max_leaves=5)
