"""Functions that learners write: the right one passes, and each wrong one is told why."""

import re

import numpy as np
import pytest
from scipy import linalg

from railbridge.lessons import trials
from railbridge.lessons.trials import TRIALS, reply


def frequencies(mass, stiffness):
    return np.sqrt(linalg.eigvalsh(stiffness, mass)) / (2 * np.pi)


def notch_shape(x, depth, length):
    inside = (x >= 0) & (x <= length)
    return -depth / 2 * (1 - np.cos(2 * np.pi * x / length)) * inside


def condense(x, y, force):
    across, up = np.asarray(force).T
    return across.sum(), up.sum(), sum(y * up), -sum(x * up), sum(x * across)


def rayleigh_coefficients(ratio, first, second):
    omega = 2 * np.pi * np.array([first, second])
    rows = np.stack([1 / (2 * omega), omega / 2], axis=1)
    return np.linalg.solve(rows, [ratio, ratio])


def static_moment(places, forces, x, span):
    total = 0.0
    for a, force in zip(places, forces, strict=True):
        if 0 <= a <= span:
            total += force * min(a * (span - x), x * (span - a)) / span
    return total


def fixed_point(function, start):
    for _ in range(200):
        start = function(start)
    return start


def steps(function, start, ends):
    """The loop with another end; `ends` may also be asked of two numbers."""
    while True:
        old, start = start, function(start)
        if np.all(ends(start - old)):
            return start


def one_force(x_i, span):
    xi = np.clip(0.5 - np.abs(x_i) / span, 0.0, None)
    return 1 / np.mean(3 * xi - 4 * xi**3), 1 / np.mean(2 * xi)


def lever_rule(x, force, places):
    forces = np.zeros(len(places))
    k = min(np.searchsorted(places, x, side="right"), len(places) - 1)
    share = (x - places[k - 1]) / (places[k] - places[k - 1])
    forces[k - 1], forces[k] = force * (1 - share), force * share
    return forces


def resonances(f_1, distance, low, high):
    last = int(f_1 * distance / low + 1e-9)
    first = int(np.ceil(f_1 * distance / high - 1e-9))
    return [f_1 * distance / i for i in range(last, max(first, 1) - 1, -1)]


def deviation(answer, x, wavenumbers, powers):
    total = np.zeros(len(x))
    for w, s in zip(wavenumbers, powers, strict=True):
        turned = answer(np.cos(w * x)) + 1j * answer(np.sin(w * x))
        total += s * np.abs(turned) ** 2
    return total**0.5


def hertz(depth, load, stiffness):
    at_rest = 1.5 * load / stiffness
    return [load * (d / at_rest) ** 1.5 if d > 0.0 else 0.0 for d in depth]


def line_speed(speeds, accelerations, limit):
    broken = np.flatnonzero(~np.all(np.asarray(accelerations) <= limit, axis=0))
    first = broken[0] if len(broken) else len(speeds)
    return speeds[first - 1] / 1.2 if first else 0.0


WRITTEN = {
    f.__name__: f
    for f in (
        frequencies, notch_shape, condense, rayleigh_coefficients, static_moment, fixed_point,
        one_force, lever_rule, resonances, deviation, hertz, line_speed,
    )
}  # fmt: skip


def test_each_trial_is_passed_by_a_function_written_here():
    assert WRITTEN.keys() == TRIALS.keys()
    for name, function in WRITTEN.items():
        assert reply(name, function).says == "right: it passes all 3 cases.", name


@pytest.mark.parametrize(
    ("name", "wrong", "words"),
    [
        ("frequencies", lambda m, k: 2 * np.pi * frequencies(m, k), "2 pi times off"),
        (
            "frequencies",
            lambda m, k: frequencies(m, k)[:1],
            "Case 2.*it returns one number, 2 numbers are expected",
        ),
        ("frequencies", lambda m, k: frequencies(m, k)[::-1], "not in the order asked for"),
        ("notch_shape", lambda x, a, b: notch_shape(x % b, a, b), "must be zero where it is not"),
        ("notch_shape", lambda x, a, b: 0 * x, "is zero where it must not be"),
        ("notch_shape", lambda x, a, b: -notch_shape(x, a, b), "the sign is not"),
        ("notch_shape", lambda x, a, b: 2 * notch_shape(x, a, b), "twice or half"),
        ("condense", lambda *a: condense(*a)[:3], "it returns 3 numbers, 5 numbers are expected"),
        ("condense", lambda *a: np.array(condense(*a)) * [1, 1, 1, -1, 1], "M_y: .*the sign"),
        (
            "rayleigh_coefficients",
            lambda *a: rayleigh_coefficients(*a)[::-1],
            "order asked for: alpha, beta",
        ),
        ("rayleigh_coefficients", lambda *a: (0.1, rayleigh_coefficients(*a)[1]), "alpha: far too"),
        ("static_moment", lambda *a: -static_moment(*a), "the sign is not"),
        ("static_moment", lambda a, f, x, span: f[0] * x * (span - x) / span, "1 of 3 cases pass"),
        ("fixed_point", lambda f, x: f(f(x)), "Case 1, x = cos x, from 1: .*too low|high"),
        ("one_force", lambda x, L: one_force(x, L)[::-1], "0 of 3 cases pass"),
        ("one_force", lambda x, L: 1 / np.array(one_force(x, L)), "sag: .*too low"),
        ("one_force", lambda x, L: one_force(x[abs(x) < L / 2], L), "2 of 3 cases pass"),
        ("lever_rule", lambda x, f, nodes: lever_rule(x, f, nodes)[::-1], "1 of 3 cases pass"),
        ("lever_rule", lambda x, f, nodes: f * (nodes == x), "1 of 3 cases pass"),
        (
            "frequencies",
            lambda m, k: np.sqrt(np.linalg.eigvalsh(np.linalg.solve(m, k))) / (2 * np.pi),
            "Case 2, .*eigvalsh is for symmetric",
        ),
        (
            "frequencies",
            lambda m, k: np.sort(np.sqrt(np.diag(k) / np.diag(m))) / (2 * np.pi),
            "each mass by itself",
        ),
        (
            "static_moment",
            lambda a, f, x, L: sum(f * np.where(a <= x, a * (L - x), x * (L - a)) / L),
            "Case 3, .*loads off the span count",
        ),
        ("deviation", lambda *a: np.array(deviation(*a)) ** 2, "Case 1, .*root at the end"),
        (
            "deviation",
            lambda f, x, w, s: np.sqrt(s @ np.array([f(np.cos(k * x)) ** 2 for k in w])),
            "cosines alone",
        ),
        (
            "deviation",
            lambda f, x, w, s: np.sqrt(
                s @ np.array([(f(np.cos(k * x)) + f(np.sin(k * x))) ** 2 for k in w])
            ),
            "each by itself",
        ),
        ("deviation", lambda f, x, w, s: deviation(f, x, w, 2 * s), "root of two off"),
        ("line_speed", lambda v, a, top: 1.2 * line_speed(v, a, top), "Case 1, .*divide"),
        ("line_speed", lambda v, a, top: line_speed(v, np.where(a < top, a, 9), top), "is kept"),
        ("line_speed", lambda v, a, top: line_speed(v, np.nan_to_num(a), top), "2 of 3.*is not"),
        ("line_speed", lambda v, a, top: max(v[(a <= top).all(0)], default=0) / 1.2, "behind a"),
        ("fixed_point", lambda f, x: steps(f, x, lambda change: change < 1e-10), "negative"),
        ("fixed_point", lambda f, x: steps(f, x, lambda change: abs(change) < 1e-3), "too early"),
        ("fixed_point", lambda f, x: f(x), "after one step"),
        ("static_moment", lambda a, f, x, L: f * x * (L - x) / L, "is a sum missing"),
        ("condense", lambda *a: "text", "no real numbers"),
        ("fixed_point", lambda f, x: np.nan, "not finite"),
        ("static_moment", lambda *a: 1 / 0, "stops with ZeroDivisionError"),
        ("static_moment", lambda a: 0, "stops with TypeError"),
    ],
)
def test_a_wrong_function_is_told_why(name, wrong, words):
    found = reply(name, wrong)
    assert not found.right and found.given
    assert re.search(words, found.says), found.says


def test_what_returns_nothing_is_no_answer_yet():
    assert not reply("condense", lambda x, y, force: ...).given
    assert not reply("condense", ...).given
    assert "without brackets" in reply("condense", 3.0).says


def test_half_a_function_has_half_the_score():
    def only_the_middle(places, forces, x, span):
        return static_moment(places, forces, x, span) if len(places) == 1 else None

    found = reply("static_moment", only_the_middle)
    assert found.score == pytest.approx(1 / 3)
    assert "Case 2" in found.says and "end with return" in found.says


def test_a_function_may_change_what_it_was_given():
    def greedy(places, forces, x, span):
        total = static_moment(places, forces, x, span)
        forces[:] = 0.0
        return total

    assert reply("static_moment", greedy).right and reply("static_moment", greedy).right


def test_a_function_that_never_ends_is_stopped(monkeypatch):
    monkeypatch.setattr(trials, "SECONDS", 0.2)

    def endless(function, start):
        while True:
            start = function(start)

    assert "does not end within 0.2 s" in reply("fixed_point", endless).says
    assert reply("fixed_point", fixed_point).right


def test_parts_in_another_order_and_a_dict_are_told():
    swapped = reply("condense", lambda *a: np.array(condense(*a))[[1, 0, 2, 3, 4]]).says
    assert "not in the order asked for: F_y, F_z, M_x, M_y, M_z" in swapped
    assert "a dict: return the numbers" in reply("condense", lambda *a: {"F_y": 1.0}).says
