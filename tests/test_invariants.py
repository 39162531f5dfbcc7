"""What must hold whatever the numbers are: order, energy, equilibrium, linearity, symmetry, and the
limits."""

import json
import os
import subprocess
import sys
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from scipy.integrate import cumulative_simpson

import railbridge as rb
from railbridge.coupling import DeckState


def few(examples):
    """Few examples, and a failing one is shown as it is: each costs seconds, and making it smaller
    would cost minutes."""
    return settings(max_examples=examples, phases=(Phase.explicit, Phase.generate))


CAR = rb.vehicle("xia2000")
PLANE_CAR = rb.planar_car(CAR)


@st.composite
def spans(draw, damped=True):
    """A sane simple span: 15 to 40 m, 5 to 15 t/m, first frequency 80 m/s over its length or so, as
    bridges have."""
    length = draw(st.floats(15.0, 40.0))
    mass = draw(st.floats(5e3, 15e3))
    frequency = draw(st.floats(60.0, 130.0)) / length
    ratio = draw(st.floats(0.005, 0.03)) if damped else 0.0
    return length, mass, mass * (2 * np.pi * frequency * length**2 / np.pi**2) ** 2, ratio


def plane_deck(span, modes=4, elements=None):
    length, mass, bending, ratio = span
    return rb.Beam("span", (length,), mass, bending, elements=elements).deck(modes, ratio)


@st.composite
def sprung_masses(draw, damped=True):
    """1 to 10 t on a spring of 0.7 to 2.5 Hz."""
    mass = draw(st.floats(1e3, 10e3))
    omega = 2 * np.pi * draw(st.floats(0.7, 2.5))
    ratio = draw(st.floats(0.05, 0.3)) if damped else 0.0
    return mass, mass * omega**2, 2 * ratio * mass * omega


@dataclass(frozen=True)
class Swell:
    """Waves that begin without a break at the entrance: a sin^2(pi x / lambda)."""

    height: float
    shortest: float

    def value(self, x):
        return self.height * np.sin(np.pi * x / self.shortest) ** 2

    def slope(self, x):
        return self.height * np.pi / self.shortest * np.sin(2 * np.pi * x / self.shortest)


swells = st.builds(Swell, height=st.floats(1e-3, 1e-2), shortest=st.floats(6.0, 20.0))
waves = st.builds(rb.Harmonic, amplitude=st.floats(5e-4, 5e-3), wavelength=st.floats(6.0, 20.0))
speeds = st.floats(15.0, 80.0)


def middle(run):
    return run.displacement(run.deck.length / 2)["displacement_z"]


def cross(train, deck, track=None, **options):
    return rb.cross(
        train, deck, track, **{"lead_in": 0.0, "tail": 0.0, "tolerance": 1e-12, **options}
    )


# Order of convergence


def order(steps, histories, reach=slice(None)):
    """Least-squares order from the differences between neighbouring halvings, at the coarsest
    step's samples."""
    common = [h[:: 2**i][reach] for i, h in enumerate(histories)]
    count = min(map(len, common))
    errors = [
        np.abs(a[:count] - b[:count]).max() for a, b in zip(common[:-1], common[1:], strict=True)
    ]
    return np.polyfit(np.log(steps[: len(errors)]), np.log(errors), 1)[0], errors


@few(6)
@given(
    span=spans(),
    mass=sprung_masses(),
    wave=waves,
    speed=speeds,
    loads=st.sampled_from(["wheels", "bogies"]),
)
def test_displacement_and_force_converge_with_the_square_of_the_step(
    span, mass, wave, speed, loads
):
    """Five halvings, so that four differences fall by four each time.

    The steps divide the time on the deck. The waves break at the entrance, where the damper's force
    jumps, and again the deck's slope breaks at its end: both samples are left out of the forces'
    order (DESIGN 5.6).
    """
    deck, train = plane_deck(span), rb.Train(rb.sprung_mass("mass", *mass))
    coarse = deck.length / speed / 128
    steps = coarse / 2.0 ** np.arange(6)
    track = rb.Track(vertical=wave)
    runs = [cross(train, deck, track, speed=speed, time_step=float(h), loads=loads) for h in steps]
    found, errors = order(steps, [middle(r) for r in runs])
    assert 1.9 < found < 2.1, errors
    found, errors = order(steps, [r.wheel_forces[0, 1] for r in runs], slice(1, 128))
    assert 1.9 < found < 2.1, errors


@few(6)
@given(span=spans(), swell=swells, speed=speeds)
def test_a_car_converges_though_its_axles_meet_the_deck_between_samples(span, swell, speed):
    """Faster than the step, not quite with its square.

    Where an axle meets the end of a bent deck its damper feels a jump, c V w', which samples place
    up to one step wrong: a small remainder that goes with the step itself. At two hundred samples a
    crossing it is some ten-thousandths.
    """
    deck, train = plane_deck(span), rb.Train(PLANE_CAR)
    steps = min(deck.length / 50, swell.shortest / 12) / speed / 2.0 ** np.arange(6)
    runs = [
        cross(train, deck, rb.Track(vertical=swell), speed=speed, time_step=float(h)) for h in steps
    ]
    found, errors = order(steps, [middle(r) for r in runs])
    assert 1.4 < found < 2.5, errors
    assert errors[2] < 4e-4 * np.abs(middle(runs[-1])).max()


@few(6)
@given(span=spans(), speed=speeds)
def test_elements_converge_with_their_fourth_power(span, speed):
    length, mass, bending, _ = span
    count = np.array([8, 16, 32])
    exact = np.pi / (2 * length**2) * np.sqrt(bending / mass) * np.array([1, 4])
    found = np.array([plane_deck(span, 2, int(c)).frequencies_hz for c in count])
    slopes = np.polyfit(np.log(count), np.log(found / exact - 1), 1)[0]
    assert slopes == pytest.approx([-4, -4], abs=0.15)
    train = rb.AxleTrain([0.0, 3.0], [1e5, 1e5])
    runs = [
        cross(train, plane_deck(span, 2, int(c)), speed=speed, time_step=length / speed / 400)
        for c in [*count, 64]
    ]
    # Of the modes alone: the static rest of the others is nearly exact on any mesh.
    half = length / 2
    shown = [r.displacement(half, kept_only=True)["displacement_z"] for r in runs]
    errors = [np.abs(one - shown[-1]).max() for one in shown[:-1]]
    assert all(a > 10 * b for a, b in zip(errors[:-1], errors[1:], strict=True)), errors


@few(6)
@given(span=spans(), mass=sprung_masses(), speed=speeds)
def test_displacement_and_moment_converge_with_modes(span, mass, speed):
    train = rb.Train(rb.sprung_mass("mass", *mass))
    runs = [
        cross(
            train,
            plane_deck(span, n, 40),
            speed=speed,
            time_step=span[0] / speed / 400,
            tolerance=1e-9,
        )
        for n in (2, 4, 8, 16)
    ]
    x = 0.4 * span[0]
    shown = [
        [r.displacement(x)["displacement_z"] for r in runs],
        [r.section_forces(x)["moment_vertical"] for r in runs],
    ]
    for histories, needed in zip(shown, (3e-4, 1e-2), strict=True):
        errors = [
            np.abs(h - histories[-1]).max() / np.abs(histories[-1]).max() for h in histories[:-1]
        ]
        assert errors[0] > errors[1] > errors[2] and errors[2] < needed, errors


# Energy


@few(6)
@given(
    span=spans(damped=False),
    mass=sprung_masses(damped=False),
    wave=waves,
    speed=speeds,
    interaction=st.sampled_from(["iterate", "direct"]),
)
def test_energy_of_an_undamped_crossing_is_what_the_traction_gives(
    span, mass, wave, speed, interaction
):
    r"""The energy of mass, spring and deck grows by the work of what pulls the train along.

    The contact moves up with u' = w_t + V w' + V r', the deck under it with w_t alone. The contact
    force F (on the deck, up) gives the deck the power F w_t and the mass and spring -F u', so that
    together they receive -F V (w' + r'): where the wheel climbs (w' + r' > 0) the contact pushes it
    back with -F (w' + r'), and the traction, which keeps V, does that work. With F = D - W, D the
    dynamic part and W the weight, the energy is, counted from rest,

        E = sum (q'^2 + omega^2 q^2) / 2 + m z'^2 / 2 + D^2 / (2 k) + W u,
        z' = -int D / m dt.

    The last term is weight lifted: the spring carries W from the start. Sideways the same holds
    without weight, with v for w.
    """
    m, k, _ = mass
    length, per_metre, bending, _ = span
    deck = rb.Beam("span", (length,), per_metre, bending, 3 * bending).deck(6)
    body = rb.Body("mass", m, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("y", "z"))
    springs = np.array([0.7 * k, k])
    spring = rb.Spring("mass", "rail", (0.0, 0.0, 0.0), tuple(springs.tolist()), (0.0, 0.0))
    train = rb.Train(rb.Vehicle("mass", (body,), (spring,), 10.0))
    sideways = rb.Harmonic(0.5 * wave.amplitude, 0.8 * wave.wavelength)
    step = length / speed / 2000
    track = rb.Track(vertical=wave, lateral=sideways)
    run = cross(train, deck, track, speed=speed, time_step=step, tail=0.2, interaction=interaction)
    t, weight = run.time, np.array([0.0, m * 9.81])[:, None]
    force = run.wheel_forces[0]
    dynamic, x = force + weight, speed * t
    shape, slope = (deck.shapes(x, d)[:, :, :2] for d in (0, 1))
    q, rate = run.state.q, run.state.velocity
    waves_slope = np.array([sideways.slope(x), wave.slope(x)])
    climb = np.einsum("kmc,mk->ck", slope, q) + waves_slope
    u = np.einsum("kmc,mk->ck", shape, q) + [sideways.value(x), wave.value(x)]

    omega = 2 * np.pi * deck.frequencies_hz[:, None]
    motion = -cumulative_simpson(dynamic / m, x=t, initial=0.0)
    of_mass = m * motion**2 / 2 + dynamic**2 / (2 * springs[:, None]) + weight * u
    energy = np.sum(rate**2 + omega**2 * q**2, axis=0) / 2 + of_mass.sum(axis=0)
    # The deck's slope ends with the deck: the work up to there and from there on is integrated
    # apart.
    end = int(np.argmax(x > deck.length * (1 + 1e-9)))
    power, power_of_waves = (-speed * np.sum(force * s, axis=0) for s in (climb, waves_slope))
    work = cumulative_simpson(power[:end], x=t[:end], initial=0.0)
    work = np.append(
        work,
        work[-1] + cumulative_simpson(power_of_waves[end - 1 :], x=t[end - 1 :], initial=0.0)[1:],
    )
    assert np.abs(energy - work).max() < 2e-5 * np.abs(energy).max()
    # Without the deck's slope in it, the balance is far off, measured by the deck's own energy.
    deck_energy = np.sum(rate**2 + omega**2 * q**2, axis=0)[:end].max() / 2
    without = cumulative_simpson(power_of_waves[:end], x=t[:end], initial=0.0)
    assert np.abs(energy[:end] - without).max() > 0.1 * deck_energy


# Equilibrium


def add_load(total, place, mesh, x, force, couple):
    """Add the consistent nodal load of a vertical force and a twisting couple at x; `place` orders
    the freedoms."""
    e = min(int(np.searchsorted(mesh.nodes, x, side="right")) - 1, len(mesh.h) - 1)
    powers = ((x - mesh.nodes[e]) / mesh.h[e]) ** np.arange(4)
    for name, value in (("vertical", force), ("torsion", couple)):
        total[place[mesh.freedoms[name][e]]] += value * (powers @ mesh.shapes[name][e])


@few(3)
@given(
    lengths=st.sampled_from([(30.0,), (20.0, 25.0)]),
    speed=st.floats(20.0, 60.0),
    offset=st.floats(-3.0, 3.0),
    loads=st.lists(st.floats(5e4, 2e5), min_size=2, max_size=2),
)
def test_reactions_are_those_of_the_unreduced_model_under_newmark(lengths, speed, offset, loads):
    """Every freedom of the mesh, stepped by average acceleration, and what is missing at a held
    freedom.

    R = (K (d + beta d') + M (d'' + alpha d') - f) there: what the bearing carries, the internal
    viscous part with it. Without that part it would be ten times off on the whole. What is left are
    modes and the samples next to an axle's stepping on or off.
    """
    alpha, beta = rb.rayleigh(0.03, (4.0, 40.0))
    beam = rb.Beam(
        "span",
        lengths,
        9e3,
        4e10,
        torsional_stiffness=4e10,
        polar_inertia=5e4,
        elements=16 * len(lengths),
    )
    deck = beam.deck(60, (alpha, beta))
    length, step = deck.length, 5e-4
    run = cross(
        rb.AxleTrain([0.0, 2.5], loads),
        deck,
        speed=speed,
        track_offset=offset,
        interaction="rigid",
        time_step=step,
        tail=0.1,
    )
    mesh, size = beam.mesh, beam.mesh.size
    held = [6 * mesh.node(s) + place for s in deck.supports for place in (2, 3)]
    # Only freedoms that move vertically or twist, the held ones last.
    free = np.setdiff1d(
        np.concatenate([mesh.freedoms[f].ravel() for f in ("vertical", "torsion")]), held
    )
    k, m = (a[np.ix_([*free, *held], [*free, *held])].toarray() for a in mesh.matrices)
    n_free = len(free)
    inverse = np.linalg.inv(
        ((1 + alpha * step / 2) * m + (beta * step / 2 + step**2 / 4) * k)[:n_free, :n_free]
    )
    damping = alpha * m + beta * k
    inner, rows = slice(n_free), slice(n_free, None)
    place = np.full(size, -1)
    place[[*free, *held]] = np.arange(n_free + len(held))
    theirs = np.zeros((len(held), len(run.time)))
    d, rate, acceleration = np.zeros((3, n_free))
    for n, t in enumerate(run.time):
        load = np.zeros(n_free + len(held))
        for delay, p in zip((0.0, 2.5), loads, strict=True):
            if 0.0 <= speed * t - delay <= length:
                add_load(load, place, mesh, speed * t - delay, -p, -p * offset)
        if n > 0:
            guess, guess_rate = (
                d + step * rate + step**2 / 4 * acceleration,
                rate + step / 2 * acceleration,
            )
            acceleration = inverse @ (
                load[inner] - damping[inner, inner] @ guess_rate - k[inner, inner] @ guess
            )
            d, rate = guess + step**2 / 4 * acceleration, guess_rate + step / 2 * acceleration
        theirs[:, n] = (
            k[rows, inner] @ (d + beta * rate)
            + m[rows, inner] @ (acceleration + alpha * rate)
            - load[rows]
        )
    theirs = dict(zip(deck.supports, theirs.reshape(-1, 2, len(run.time)), strict=True))
    for s, history in run.reactions().items():
        limits = [("force_z", 1.0, 8e-3, 6e-4), ("moment_x", max(abs(offset), 0.1), 2.5e-2, 1.5e-3)]
        for known, (name, size, most, usual) in zip(theirs[s], limits, strict=True):
            error = np.abs(history[name] - known) / (size * max(loads))
            assert error.max() < most and np.sqrt(np.mean(error**2)) < usual, (s, name)


# Linearity


@few(6)
@given(
    span=spans(),
    speed=speeds,
    first=st.floats(5e4, 2e5),
    second=st.floats(5e4, 2e5),
    apart=st.integers(20, 200),
)
def test_two_trains_of_axles_superpose(span, speed, first, second, apart):
    deck, step = plane_deck(span), span[0] / speed / 200
    gap = apart * speed * step

    def run(axles, loads):
        return cross(
            rb.AxleTrain(axles, loads),
            deck,
            speed=speed,
            interaction="rigid",
            time_step=step,
            tail=3.0,
        )

    ahead, behind, both = (
        run([0.0], [first]),
        run([0.0], [second]),
        run([0.0, gap], [first, second]),
    )
    count = len(ahead.time)
    for values in (
        middle,
        lambda r: r.section_forces(span[0] / 3)["moment_vertical"],
        lambda r: r.reactions()[0.0]["force_z"],
    ):
        total = values(ahead).copy()
        total[apart:] += values(behind)[: count - apart]
        assert values(both)[:count] == pytest.approx(total, abs=1e-9 * np.abs(total).max())


@few(6)
@given(span=spans(), swell=swells, speed=speeds, factor=st.floats(0.2, 3.0))
def test_response_is_affine_in_the_irregularity(span, swell, speed, factor):
    deck, train = plane_deck(span), rb.Train(PLANE_CAR)
    step = span[0] / speed / 200

    def run(size):
        track = rb.Track(vertical=Swell(size * swell.height, swell.shortest))
        return cross(train, deck, track, speed=speed, time_step=step, interaction="direct")

    level, once, scaled = run(0.0), run(1.0), run(factor)
    for values in (middle, lambda r: r.wheel_forces[:, 1]):
        expected = values(level) + factor * (values(once) - values(level))
        assert np.abs(values(scaled) - expected).max() < 1e-9 * np.abs(expected).max()


# Symmetry


@few(3)
@given(
    offset=st.floats(0.5, 3.0),
    vertical=waves,
    lateral=waves,
    speed=speeds,
    loads=st.sampled_from(["wheels", "condensed"]),
)
def test_a_train_on_the_other_track_gives_the_mirror_image(offset, vertical, lateral, speed, loads):
    deck, train = rb.deck("viaduct36"), rb.Train(CAR)

    def run(sign):
        high = (
            rb.Harmonic(vertical.amplitude, vertical.wavelength),
            rb.Harmonic(0.5 * vertical.amplitude, 11.0),
        )
        side = rb.Harmonic(lateral.amplitude, lateral.wavelength, phase=0.0 if sign > 0 else np.pi)
        track = rb.Track(vertical=rb.Rails(*high[::sign]), lateral=side)
        return cross(
            train, deck, track, speed=speed, loads=loads, track_offset=sign * offset,
            time_step=0.04 / speed,
            tolerance=1e-10,
        )  # fmt: skip

    left, right = run(1), run(-1)
    same, opposite = (1.0, 1e-8), (-1.0, 1e-8)
    signs = {"displacement_y": opposite, "displacement_z": same, "rotation_x": opposite}
    signs |= {
        "moment_vertical": same,
        "moment_lateral": opposite,
        "torsion": opposite,
        "shear_vertical": same,
    }
    for x in (9.0, 18.0):
        for histories in (lambda r, x=x: r.displacement(x), lambda r, x=x: r.section_forces(x)):
            a, b = histories(left), histories(right)
            for name in a.values.keys() & signs.keys():
                sign, limit = signs[name]
                assert np.abs(a[name] - sign * b[name]).max() <= limit * np.abs(a[name]).max(), name
    # Left and right wheels of an axle change places, lateral forces their sign.
    swapped = right.wheel_forces.reshape(4, 2, 2, -1)[:, ::-1] * np.array([-1.0, 1.0])[:, None]
    assert (
        np.abs(left.wheel_forces - swapped.reshape(8, 2, -1)).max()
        < 1e-8 * np.abs(left.wheel_forces).max()
    )


# Limits


@few(6)
@given(span=spans(), place=st.floats(0.1, 0.9), part=st.floats(0.1, 0.9))
def test_infinitely_slow_crossing_gives_the_influence_lines(span, place, part):
    """At a micrometre a second: moment, shear, reactions and displacement to 1e-8."""
    deck, train = plane_deck(span, 12), rb.Train(PLANE_CAR)
    run = cross(train, deck, speed=1e-6, time_step=2e4, tolerance=1e-9)
    n = int(place * len(run.time))
    x = 1e-6 * run.time[n] - np.array([w.delay for w in train.wheels])
    x = x[(x >= 0.0) & (x <= deck.length)]
    load, at = train.wheels[0].static_load, part * deck.length
    if np.any(np.abs(x - at) < 0.05):
        at = float(min(max(x.min() - 1.0, 0.02), deck.length / 2))

    def lever(x, at):
        return np.where(x <= at, x * (deck.length - at), at * (deck.length - x)) / deck.length

    assert run.section_forces(at)["moment_vertical"][n] == pytest.approx(
        -load * lever(x, at).sum(), rel=1e-8
    )
    assert run.reactions()[0.0]["force_z"][n] == pytest.approx(
        load * (1 - x / deck.length).sum(), rel=1e-8
    )
    assert run.reactions()[deck.length]["force_z"][n] == pytest.approx(
        load * (x / deck.length).sum(), rel=1e-8
    )
    b = np.minimum(x, deck.length - x)
    sag = -load * np.sum(b * (3 * deck.length**2 - 4 * b**2)) / (48 * span[2])
    assert run.displacement(deck.length / 2)["displacement_z"][n] == pytest.approx(sag, rel=1e-8)


@few(8)
@given(
    offset=st.floats(-3.0, 3.0), aside=st.floats(-0.25, 0.25), ahead=st.floats(0.5, 1.5),
    place=st.floats(0.2, 0.8),
    interaction=st.sampled_from(["iterate", "direct", "rigid"]), loads=st.sampled_from(["wheels",
    "condensed"]),
)  # fmt: skip
def test_bearings_carry_the_weight_where_it_stands(offset, aside, ahead, place, interaction, loads):
    """A body off the middle of its wheels, at rest: forces, couple about the deck's axis and
    deflection, with their signs.

    One resultant in the middle bends the deck like ``F eta - eta' M_y``, the wheels like the sum of
    ``F eta``.
    """
    body = rb.Body("body", 5e3, (2e3, 2e4, 0.0), (ahead, aside, 1.0), ("z", "roll", "pitch"))
    corners = [(x, y, 0.0) for x in (3.0, -3.0) for y in (0.98, -0.98)]
    springs = tuple(rb.Spring("body", "rail", at, (0.0, 1e6), (0.0, 1e3)) for at in corners)
    train = rb.Train(rb.Vehicle("aside", (body,), springs, 10.0))
    deck, weight = rb.deck("viaduct36"), 5e3 * 9.81
    loads = "wheels" if interaction == "direct" else loads
    run = cross(
        train,
        deck,
        speed=1e-6,
        time_step=1e5,
        track_offset=offset,
        interaction=interaction,
        loads=loads,
        tolerance=1e-9,
    )
    n = int(place * (len(run.time) - 1))
    middle_of_car = 1e-6 * run.time[n] - 3.0
    share = 1 - (middle_of_car + ahead) / 36.0
    first, second = run.reactions().values()
    # Round-off of some 1e-9, most in the direct solution: a step lasts 1e7 of its fastest periods.
    assert [first["force_z"][n], second["force_z"][n]] == pytest.approx(
        [weight * share, weight * (1 - share)], rel=1e-7
    )
    couple = weight * (offset + aside)
    # Where wheels stand at different distances from the middle of the track, their own share of the
    # couple differs too.
    assert first["moment_x"][n] + second["moment_x"][n] == pytest.approx(couple, rel=1e-6, abs=1e-2)
    line = deck.recovery.section("displacement_z", 12.0).influence
    if loads == "wheels":
        sag = -sum(
            w.static_load * line(np.array([middle_of_car + 3.0 - w.delay]))[0, 0, 1]
            for w in train.wheels
        )
    else:
        eta, slope = (line(np.array([middle_of_car]), d)[0, 0, 1] for d in (0, 1))
        sag = -weight * (eta + ahead * slope)
    assert run.displacement(12.0)["displacement_z"][n] == pytest.approx(sag, rel=1e-6)


@few(3)
@given(offset=st.floats(-3.0, 3.0), wave=waves, speed=speeds)
def test_a_rigid_deck_gives_the_rigid_deck_forces_exactly(offset, wave, speed):
    """A deck stiff in every way gives them to round-off; one that cannot move sideways gives the
    lateral ones bit by bit."""
    track = rb.Track(
        vertical=wave, lateral=rb.Harmonic(0.4 * wave.amplitude, 1.3 * wave.wavelength)
    )
    train, options = (
        rb.Train(CAR),
        {"speed": speed, "track_offset": offset, "time_step": 0.04 / speed},
    )
    stiff = rb.Beam("stiff", (36.0,), 12e3, 1e24, 1e24, 1e24, polar_inertia=7e4).deck(20, 0.03)
    rigid = cross(train, stiff, track, interaction="rigid", **options).wheel_forces
    for interaction in ("iterate", "direct"):
        forces = cross(train, stiff, track, interaction=interaction, **options).wheel_forces
        assert np.abs(forces - rigid).max() < 1e-12 * np.abs(rigid).max()
    plane = rb.Beam("plane", (36.0,), 12e3, 9e10).deck(5, 0.03)
    run = cross(train, plane, track, **options)
    lateral = run.wheel_forces[:, 0] - run.at(0).wheel_forces[:, 0]
    assert np.abs(lateral).max() < 1e-12 * np.abs(rigid).max()
    assert np.abs(run.wheel_forces[:, 1] - rigid[:, 1]).max() > 1e-6 * np.abs(rigid).max()


@dataclass(frozen=True)
class Frozen:
    """A deflected deck as an irregularity: what a rail at y meets, with the slope by finite
    elements' own derivative."""

    deck: rb.Deck
    q: np.ndarray
    y: float | None
    shortest: float = 36.0

    def _met(self, x, derivative):
        v, w, twist = np.einsum("kmc,m->ck", self.deck.shapes(x, derivative), self.q)
        return v if self.y is None else w + self.y * twist

    def value(self, x):
        return self._met(x, 0)

    def slope(self, x):
        return self._met(x, 1)


@few(4)
@given(
    offset=st.floats(-3.0, 3.0), speed=st.sampled_from([20.0, 55.0, 90.0]), seed=st.integers(0, 9)
)
def test_a_fixed_deflected_shape_is_felt_like_the_same_irregularity(offset, speed, seed):
    """The convective term: on a deck that stands still in a bent shape, the wheels' input changes
    by V times its slope."""
    deck, train = rb.deck("viaduct36"), rb.Train(CAR, cars=2)
    q = np.random.default_rng(seed).normal(size=8)
    q = np.append(q, np.zeros(len(deck.frequencies_hz) - 8))
    half = CAR.contacts[0].y
    bent = rb.Track(
        vertical=rb.Rails(Frozen(deck, q, offset + half), Frozen(deck, q, offset - half)),
        lateral=Frozen(deck, q, None),
    )
    # A run-up, though there is nothing to run over, and a step that falls on no element's end,
    # where the twist's slope breaks: rounding must not decide on which side of a break a sample
    # lies.
    options = {
        "speed": speed,
        "track_offset": offset,
        "time_step": 0.01 * np.pi / speed,
        "interaction": "rigid",
        "lead_in": None,
    }
    level, bumpy = cross(train, deck, **options), cross(train, deck, bent, **options)
    still = np.repeat(q[:, None], len(level.time), axis=1)
    felt = level.coupling.train_pass(DeckState(still, np.zeros_like(still), np.zeros_like(still)))
    # The second car: the first one's record starts on the deck's end, without the sample before it.
    second = level.coupling.cars[1]
    window, ours, known = second.window, felt[1], bumpy.coupling.cars[1].rigid
    assert np.abs(ours - known[..., window]).max() < 1e-6 * np.abs(known).max()


_IN_NUMBERS = """
import json, railbridge as rb
case = rb.case("paper").replace({"train.cars": 2, "run.time_step": 2e-3})
print(json.dumps(case.summary()))
"""


def test_the_number_of_threads_changes_nothing():
    """The libraries below may share their work as they like."""

    def numbers(threads):
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        env = os.environ | dict.fromkeys(names, str(threads))
        done = subprocess.run(
            [sys.executable, "-c", _IN_NUMBERS], env=env, capture_output=True, text=True, check=True
        )
        return json.loads(done.stdout)

    def leaves(value):
        if isinstance(value, dict):
            return [leaf for v in value.values() for leaf in leaves(v)]
        return [leaf for v in value for leaf in leaves(v)] if isinstance(value, list) else [value]

    one, many = (leaves(numbers(threads)) for threads in (1, 8))
    assert len(one) == len(many) > 300
    for a, b in zip(one, many, strict=True):
        assert a == (pytest.approx(b, rel=1e-9, abs=1e-9) if isinstance(b, float) else b)
