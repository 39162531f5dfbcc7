"""The comparing line says what it compares, and fails where it must."""

import pytest

from railbridge import compared


def test_line_names_everything():
    line = compared("car mode 4", 1.33446, 1.334, "Hz", limit=0.5)
    assert line.split() == ["car", "mode", "4", "1.334", "Hz", "paper", "1.334", "Hz", "limit", "0.5", "%", "ok"]


@pytest.mark.parametrize("value", [1.35, -1.334, float("nan"), float("inf")])
def test_a_difference_beyond_the_limit_fails(value):
    with pytest.raises(AssertionError, match="car mode 4"):
        compared("car mode 4", value, 1.334, "Hz", limit=0.5)
