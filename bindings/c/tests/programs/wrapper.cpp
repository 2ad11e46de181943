// The class: the numbers of the C functions, and copies that are runs of their own.

#include <cmath>
#include <cstdio>
#include <type_traits>

#include "cart_pole.h"
#include "ring.h"
#include "spherical.h"
#include "swing.h"
#include "winch.h"

static_assert(std::is_trivially_copyable_v<cart_pole_run> && sizeof(cart_pole_run) == sizeof(cart_pole_memory));
static_assert(noexcept(cart_pole_run{}.set_step_size(0.1)));

int main()
{
    const cart_pole_parameters parameters{1.0, 0.3, 0.4, {0.3, 0.004}};
    const std::array<double, 1> u{0.5};
    cart_pole_run run;
    if (run.step(u) != DALEMBERT_NOT_INITIALISED || run.init(parameters, 0.01, {0.0, 0.2}, {0.0, 0.0}) != DALEMBERT_OK)
        return 1;

    cart_pole_memory memory{};
    const double q0[2] = {0.0, 0.2}, v0[2] = {0.0, 0.0};
    if (cart_pole_init(&memory, &parameters, 0.01, q0, v0) != DALEMBERT_OK)
        return 2;
    dalembert_report report{};
    cart_pole_linearized linearized{}, expected{};
    cart_pole_run::vector q{}, p{}, v{}, ahead{};
    double qc[2], pc[2], energy = 0.0, time = 0.0;
    for (int k = 0; k < 100; k++) {
        if (run.step(u, &report) != DALEMBERT_OK || cart_pole_step(&memory, u.data(), nullptr) != DALEMBERT_OK)
            return 3;
        if (run.state(q, p) != DALEMBERT_OK || cart_pole_state(&memory, qc, pc) != DALEMBERT_OK)
            return 4;
        if (q[0] != qc[0] || q[1] != qc[1] || p[0] != pc[0] || p[1] != pc[1])
            return 5;
    }
    if (run.step(u, linearized) != DALEMBERT_OK || cart_pole_step_linearized(&memory, u.data(), nullptr, &expected) != DALEMBERT_OK ||
        linearized.by_state[3][1] != expected.by_state[3][1] || linearized.by_input[2][0] != expected.by_input[2][0])
        return 6;
    cart_pole_run copy = run;
    const cart_pole_run &looked_at = copy;
    if (looked_at.state_after(u, 0.01, ahead, p) != DALEMBERT_OK || run.step(u) != DALEMBERT_OK || run.state(q, p) != DALEMBERT_OK ||
        std::fabs(q[0] - ahead[0]) > 1e-15 || looked_at.state(v, p) != DALEMBERT_OK || v == q)
        return 7;
    if (looked_at.time(time) != DALEMBERT_OK || std::fabs(time - 1.01) > 1e-15 || looked_at.energy(energy) != DALEMBERT_OK ||
        looked_at.velocity(v) != DALEMBERT_OK || run.set_state(q, p) != DALEMBERT_OK || run.set_parameters(parameters) != DALEMBERT_OK ||
        run.set_step_size(0.0) != DALEMBERT_STEP_SIZE || run.set_step_size(0.02) != DALEMBERT_OK)
        return 8;

    winch_run winch;
    swing_run swing;
    ring_run ring;
    winch_run::vector angle{};
    winch_linearized by_input{};
    double t = 0.0;
    if (winch.init({0.1, 0.2}, 0.1, t, {0.3}, {0.0}) != DALEMBERT_OK || winch.step({0.1, 0.2}, t) != DALEMBERT_OK ||
        winch.step({0.1, 0.2}, t + 0.1, by_input) != DALEMBERT_OK || winch.velocity(t + 0.2, angle) != DALEMBERT_OK ||
        winch.energy(t + 0.2, energy) != DALEMBERT_OK || winch.state_after({0.0, 0.0}, t + 0.2, 0.1, angle, angle) != DALEMBERT_OK)
        return 9;
    if (swing.init({0.1}, 0.1, t, {0.3}, {0.0}) != DALEMBERT_OK || swing.step(t) != DALEMBERT_OK)
        return 10;
    if (ring.init({1, 0.01f, {{1.0f}, {}}, {}}, 0.1f, {0.0f, 1.2f}, {0.5f, 0.0f}) != DALEMBERT_OK || ring.step() != DALEMBERT_OK)
        return 11;

    const spherical_parameters sphere{1.3, 0.4};
    spherical_run bob;
    spherical_run::vector place{}, speed{};
    std::array<double, 1> lambda{};
    dalembert_violation violation{};
    if (bob.init(sphere, 0.1, {0.0, 0.0, -1.1}, {}) != DALEMBERT_OFF_CONSTRAINT ||
        spherical_run::violation(sphere, {0.0, 0.0, -1.1}, {}, violation) != DALEMBERT_OK || std::fabs(violation.amount - 0.105) > 1e-15 ||
        spherical_run::nearest(sphere, {0.0, 0.0, -1.1}, {}, place, speed) != DALEMBERT_OK || bob.init(sphere, 0.1, place, speed) != DALEMBERT_OK)
        return 12;
    if (bob.reactions(lambda) != DALEMBERT_NO_STEP || bob.step() != DALEMBERT_OK || bob.reactions(lambda) != DALEMBERT_OK ||
        std::fabs(lambda[0] + 1.3 * 9.81) > 1e-12)
        return 13;
    std::puts("as in C");
    return 0;
}
