r"""Train and deck stepped together, sample by sample: the arrays, and the loop in NumPy.

All systems are in the form of `response`: what a car keeps from one sample to the next is its state
without the new sample's input, s, so that with the new input U

    y = R s + D U,        s of the next sample = S s + Q U,

and of every mode of the deck, with its new modal force f,

    (q, q') = (q, q')* + (r_q, r_v) f.

At each sample cars and deck meet in the forces. With Phi the shapes at the axles and Phi' times V
their slopes (three rows an axle: y, z, roll), Psi the rows of the load stations, L the car's
`load_matrix`, and K, C the stiffness and damping of the contacts on what a wheel feels of its axle,

    m = Phi q,  m' = V Phi' q + Phi q',         the deck below the axles,
    U = u_rail + K m + C m' + p,                what the car's contacts are given,
    F = F_known + y - U,                        the forces of the wheels on the deck,
    f = sum over cars of Psi^T L F,             those on the modes.

Everything but p is linear, which leaves one system of the size of the number of modes. On permanent
contact p = 0, and cars are stepped only while they are on the deck: `F_known` is then their force
on a rigid deck.

A Hertzian contact carries

    P = P0 (d / d0)^(3/2) (1 + c d' / P0)

where it is pressed together by d > 0, and nothing where that is not positive; d0 = 3 P0 / (2 k) and
the damping (Hunt & Crossley 1975) make k and c its spring and damper at the static load P0. Where
these are stretched by e it is pressed by ``d = d0 - e``, and p, what it carries more than they do,
is the solution of

    p = P(d, d') - P0 + k e + c e'

for all wheels at once, by Newton's method in each step (`pressing`). Cars are then stepped over the
whole record from the start of their run-up.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import brief
from .plans import CarSteps, Plan

__all__ = ["Marched", "handed_on", "march", "pressing", "step"]

TOLERANCE = 1e-13
"""Of how deep a contact is pressed in a step, share of its depth at rest."""
MOST = 60
"""Newton's steps in one sample."""


@dataclass(frozen=True, eq=False)
class Marched:
    """What the loop gives.

    Attributes
    ----------
    q, velocity, force : ndarray, shape (modes, samples)
        The deck's, from its first sample on.
    more : tuple of ndarray, shape (wheels, samples of the window)
        p of every car, N; empty where the contact is permanent.
    """

    __repr__ = brief

    q: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    more: tuple[np.ndarray, ...] = ()


@dataclass(frozen=True, eq=False)
class _Met:
    """One car at one sample, before the deck's new forces are known.

    Attributes
    ----------
    car : int
    u : ndarray, shape (d,)
        U without the deck's new forces and without p.
    force : ndarray, shape (d,)
        F with that.
    per : ndarray, shape (d, modes), or None
        What the deck's new forces add to U; None off the deck.
    back : ndarray, shape (modes, d), or None
        Psi^T L.
    through : ndarray, shape (modes, d), or None
        From what U gets more to the deck's forces.
    """

    car: int
    u: np.ndarray
    force: np.ndarray
    per: np.ndarray | None = None
    back: np.ndarray | None = None
    through: np.ndarray | None = None


def march(plan: Plan, progress: Callable[[str], None] | None = None) -> Marched:
    """Step train and deck together, in NumPy.

    Raises
    ------
    ArithmeticError
        A contact force that Newton's method does not find.
    """
    modes = plan.reach.shape[1]
    deck = np.zeros((3, modes, plan.samples))
    states = [car.at_rest for car in plan.cars]
    more: tuple[np.ndarray, ...] = ()
    if plan.rail is not None:
        more = tuple(np.zeros((len(own) // 2, own.shape[1])) for own in plan.rail)
    memory = [np.zeros((2, len(own) // 2)) for own in plan.rail or ()]
    before = np.zeros((3, modes))
    for k in range(plan.first, plan.samples):
        if progress is not None and k % 500 == 0:
            progress(f"step {k} of {plan.samples}")
        before, inputs = step(plan, k, before, states, more, memory)
        if k >= 0:
            deck[:, :, k] = before
        for i, u in inputs.items():
            states[i] = handed_on(plan.cars[i], states[i], u[:, None])
    return Marched(*deck, more)


def step(
    plan: Plan,
    k: int,
    before: np.ndarray,
    states: Sequence[np.ndarray],
    more: tuple[np.ndarray, ...] = (),
    memory: list[np.ndarray] | None = None,
) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Solve train and deck at one sample.

    Parameters
    ----------
    plan : Plan
    k : int
    before : ndarray, shape (3, modes)
        q, q' and the modal forces of the sample before.
    states : sequence of ndarray
        s of every car.
    more : tuple of ndarray
        See `Marched`; this sample's is filled in.
    memory : list of ndarray
        Of every car what `pressing` remembers; this sample's is filled in.

    Returns
    -------
    ndarray, shape (3, modes)
        q, q' and the modal forces.
    dict of ndarray, shape (d,)
        U of the cars that are stepped, by number.
    """
    modes = plan.reach.shape[1]
    still = np.zeros(modes)
    ahead, rate, reach = still, still, (still, still)
    if k > 0:
        e, reach = plan.onward, plan.reach
        ahead = e[0] * before[0] + e[1] * before[1] + e[4] * before[2]
        rate = e[2] * before[0] + e[3] * before[1] + e[5] * before[2]
    met = [
        _meet(plan, i, k, states[i], (ahead, rate), reach)
        for i, (start, stop) in enumerate(plan.windows)
        if start <= k < stop
    ]
    on = [own for own in met if own.per is not None]
    new = still
    if on:
        coupled = np.eye(modes) - sum(own.through @ own.per for own in on)
        new = np.linalg.solve(coupled, sum(own.back @ own.force for own in on))
    if plan.pressed is not None:
        for own in met:
            if own.per is None:
                _press(plan, k, [own], more, memory)
        if on:
            through = [own.through[:, 1::2] for own in on]
            gain = np.linalg.solve(coupled, np.concatenate(through, axis=1))
            new = new + gain @ _press(plan, k, on, more, memory, new, gain)
    inputs = {}
    for own in met:
        u = inputs[own.car] = own.u if own.per is None else own.u + own.per @ new
        if plan.pressed is not None:
            u[1::2] += more[own.car][:, k - plan.windows[own.car, 0]]
    return np.stack([ahead + reach[0] * new, rate + reach[1] * new, new]), inputs


def handed_on(car: CarSteps, state: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Return s behind some samples with inputs U, shape (d, n); only one where S is no diagonal."""
    if u.shape[1] == 1:
        kept = car.decay * state if car.decay.ndim == 1 else car.decay @ state
        return kept + car.drive @ u[:, 0]
    n = u.shape[1]
    powers = car.decay[:, None] ** np.arange(n - 1, -1, -1)
    return car.decay**n * state + np.einsum("mn,mn->m", powers, car.drive @ u)


def _meet(
    plan: Plan,
    number: int,
    k: int,
    state: np.ndarray,
    deck: tuple[np.ndarray, np.ndarray],
    reach: Sequence[np.ndarray],
) -> _Met:
    """Return one car at a sample, with the deck as it is without its new forces."""
    car, at = plan.cars[number], k - plan.windows[number, 0]
    known = plan.known[number]
    force = known[:, min(at, known.shape[1] - 1)] + (car.show @ state).real
    u = np.zeros(len(force)) if plan.rail is None else plan.rail[number][:, at].copy()
    axle, axles, load, loads = plan.of_cars[number]
    below = [_row(plan.tables, plan.axles[i], k) for i in range(axle, axle + axles)]
    under = [_row(plan.load_tables, plan.loads[i], k) for i in range(load, load + loads)]
    if all(own is None for own in (*below, *under)):
        return _Met(number, u, force + car.direct @ u)
    modes = plan.reach.shape[1]
    none = np.zeros((2, 3, modes))
    shapes, slopes = np.concatenate([none if own is None else own for own in below], axis=1)
    none = np.zeros((len(car.loads) // loads, modes))
    acting = np.concatenate([none if own is None else own for own in under])
    of_motion, of_rate = car.stiffness @ shapes + car.damping @ slopes, car.damping @ shapes
    u += of_motion @ deck[0] + of_rate @ deck[1]
    back = acting.T @ car.loads
    per = of_motion * reach[0] + of_rate * reach[1]
    return _Met(number, u, force + car.direct @ u, per, back, back @ car.direct)


def _row(tables: Sequence[np.ndarray], station: np.ndarray, k: int) -> np.ndarray | None:
    """Return a station's part of a table at a sample, None off the deck."""
    start, count, which = station
    return tables[which][k - start] if 0 <= k - start < count else None


def _press(
    plan: Plan,
    k: int,
    met: Sequence[_Met],
    more: tuple[np.ndarray, ...],
    memory: list[np.ndarray],
    new: np.ndarray | None = None,
    gain: np.ndarray | None = None,
) -> np.ndarray:
    """Find what the contacts of some cars carry more than their tangents, and note it in `more`.

    Parameters
    ----------
    plan : Plan
    k : int
    met : sequence of _Met
        Cars that meet: all on the deck, or one off it.
    more : tuple of ndarray
        See `Marched`.
    memory : list of ndarray
        See `step`.
    new : ndarray, shape (modes,), optional
        The deck's new forces with p = 0.
    gain : ndarray, shape (modes, wheels), optional
        What p adds to them.

    Returns
    -------
    ndarray, shape (wheels,)
        N.
    """
    cars = [plan.cars[own.car] for own in met]
    ends = np.cumsum([0, *(len(own.u) // 2 for own in met)])
    linear, answer = np.zeros(ends[-1]), np.zeros((ends[-1], ends[-1]))
    for own, car, a, b in zip(met, cars, ends[:-1], ends[1:], strict=True):
        forces = own.force
        answer[a:b, a:b] = car.direct[1::2, 1::2]
        if gain is not None:
            per = car.direct[1::2] @ own.per
            answer[a:b] += per @ gain
            linear[a:b] = forces[1::2] + per @ new
        else:
            linear[a:b] = forces[1::2]
    contacts = np.concatenate([plan.pressed[own.car] for own in met], axis=1)
    before = np.concatenate([memory[own.car] for own in met], axis=1)
    found, after = pressing(linear, answer, contacts, before)
    for own, a, b in zip(met, ends[:-1], ends[1:], strict=True):
        memory[own.car] = after[:, a:b]
        more[own.car][:, k - plan.windows[own.car, 0]] = found[a:b]
    return found


def pressing(
    linear: np.ndarray, answer: np.ndarray, contacts: np.ndarray, memory: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return p of Hertzian contacts, N, and what to remember of them.

    With H the answer, the contacts carry ``P = -(linear + H p)``. Their springs and dampers are
    stretched by e with ``k e + c e' = g = P0 - P + p``, which the exact step for a g that is linear
    between samples turns into ``e = alpha + beta g``. So the depth ``d = d0 - e`` follows from P
    alone, ``d + A P = d*``, where A is how much a contact opens in the step under its own force and
    d* how deep it would be without one; and d' follows from d. P(d) grows and bends upwards, so
    that Newton's method falls to the solution from d*, without turning back.

    Parameters
    ----------
    linear : ndarray, shape (wheels,)
        Forces on the deck with p = 0, N.
    answer : ndarray, shape (wheels, wheels)
        What p adds to them.
    contacts : ndarray, shape (6, wheels)
        See `Plan.pressed`.
    memory : ndarray, shape (2, wheels)
        e (m) and g (N) of the sample before.

    Returns
    -------
    p : ndarray, shape (wheels,)
    memory : ndarray, shape (2, wheels)
        e and g of this sample.

    Raises
    ------
    ArithmeticError
        Where it does not settle.
    """
    load, depth, damping, decay, before, beta = contacts
    k, count = 1.5 * load / depth, len(load)
    alpha = decay * memory[0] + before * memory[1]
    solved = np.linalg.solve(answer, np.column_stack([np.eye(count), linear]))
    inverse, of_linear = solved[:, :count], solved[:, count]
    opening = -beta[:, None] * (np.eye(count) + inverse)
    free = depth - alpha - beta * (load - of_linear)
    # d' = rate + stiffer d / c: nothing where there is no damper.
    with_damper = damping > 0.0
    share_of_rate = np.where(with_damper, (1.0 / beta - k) / load, 0.0)
    still = depth - np.where(with_damper, alpha / (1.0 - k * beta + (~with_damper)), 0.0)
    d = free.copy()
    for _ in range(MOST):
        share = np.maximum(d / depth, 0.0)
        more = 1.0 + share_of_rate * (d - still)
        force = np.maximum(load * share**1.5 * more, 0.0)
        tangent = k * np.sqrt(share) * more + load * share**1.5 * share_of_rate
        tangent = np.where(force > 0.0, tangent, 0.0)
        wrong = d + opening @ force - free
        step = np.linalg.solve(np.eye(count) + opening * tangent, wrong)
        d = d - step
        if np.max(np.abs(step) / depth) <= TOLERANCE:
            share = np.maximum(d / depth, 0.0)
            force = load * share**1.5 * (1.0 + share_of_rate * (d - still))
            force = np.maximum(force, 0.0)
            p = -(inverse @ force + of_linear)
            return p, np.stack([depth - d, load - force + p])
    raise ArithmeticError("a contact force does not settle within a step")
