/* Runs of every kind of system, bit by bit. All objects are on the heap and as large as declared, so that a byte beyond them is seen. */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cart_pole.h"
#include "ring.h"
#include "swing.h"
#include "winch.h"

static void require(dalembert_status status)
{
    if (status != DALEMBERT_OK) {
        fprintf(stderr, "%s\n", cart_pole_text(status));
        exit(EXIT_FAILURE);
    }
}

static void *room(size_t size)
{
    void *bytes = malloc(size);
    if (bytes == NULL)
        exit(EXIT_FAILURE);
    memset(bytes, 0xa5, size);
    return bytes;
}

static void show(const char *name, const double *values, size_t count)
{
    size_t i;
    printf("%s", name);
    for (i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        printf(" %016" PRIx64, bits);
    }
    printf("\n");
}

static void show_single(const char *name, const float *values, size_t count)
{
    double wide[16];
    size_t i;
    for (i = 0; i < count; i++)
        wide[i] = (double)values[i];
    show(name, wide, count);
}

static void cart_poles(void)
{
    cart_pole_memory *run = room(sizeof *run), *copy = room(sizeof *copy);
    cart_pole_parameters *parameters = room(sizeof *parameters);
    cart_pole_linearized *linearized = room(sizeof *linearized);
    dalembert_report *report = room(sizeof *report);
#ifdef SHORT
    double *q = room(sizeof(double)); /* the control: one number too short */
#else
    double *q = room(2 * sizeof(double));
#endif
    double *p = room(2 * sizeof(double)), *u = room(sizeof(double)), *scalar = room(sizeof(double));
    const double start[2] = {0.1, 0.2}, rest[2] = {0.0, -0.3};
    int k;

    parameters->cart = 1.0;
    parameters->rod = 0.3;
    parameters->half_length = 0.4;
    parameters->friction[0] = 0.3;
    parameters->friction[1] = 0.004;
    require(cart_pole_init(run, parameters, 0.01, start, rest));
    for (k = 0; k < 50; k++) {
        u[0] = 0.25 * (k % 5) - 0.5;
        require(cart_pole_step(run, u, report));
        require(cart_pole_state(run, q, p));
        show("cart_pole q", q, 2);
        show("cart_pole p", p, 2);
        show("cart_pole time", &report->time, 1);
    }
    *copy = *run;
    require(cart_pole_step_linearized(run, u, NULL, linearized));
    show("cart_pole A", &linearized->by_state[0][0], 16);
    show("cart_pole B", &linearized->by_input[0][0], 4);
    parameters->rod = 0.35;
    require(cart_pole_set_parameters(run, parameters));
    require(cart_pole_set_step_size(run, 0.02));
    require(cart_pole_step(run, u, NULL));
    require(cart_pole_velocity(run, q));
    show("cart_pole v", q, 2);
    require(cart_pole_energy(run, scalar));
    show("cart_pole energy", scalar, 1);
    require(cart_pole_state_after(run, u, -0.01, q, p));
    show("cart_pole before", q, 2);
    require(cart_pole_set_state(run, q, p));
    require(cart_pole_step(run, u, NULL));
    require(cart_pole_state(run, q, p));
    show("cart_pole corrected", q, 2);
    require(cart_pole_time(run, scalar));
    show("cart_pole time", scalar, 1);
    require(cart_pole_step(copy, u, NULL));
    require(cart_pole_state(copy, q, p));
    show("cart_pole copy", q, 2);
#ifdef BEYOND
    show("the control: one number too many", q, 3);
#endif
    free(run);
    free(copy);
    free(parameters);
    free(linearized);
    free(report);
    free(q);
    free(p);
    free(u);
    free(scalar);
}

static void rings(void)
{
    ring_memory run;
    const ring_parameters parameters = {1, 0.01f, {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.125f}}, {1, 2, 3}};
    const float start[2] = {0.0f, 1.155f}, velocity[2] = {0.5f, 0.0f};
    float q[2], p[2];
    ring_linearized linearized;
    int k;

    require(ring_init(&run, &parameters, 0.125f, start, velocity));
    for (k = 0; k < 50; k++) {
        require(ring_step(&run, NULL));
        require(ring_state(&run, q, p));
        show_single("ring q", q, 2);
    }
    require(ring_step_linearized(&run, NULL, &linearized));
    show_single("ring A", &linearized.by_state[0][0], 16);
    show_single("ring by k", &linearized.by_parameters[0][0], 4);
}

static void winches(void)
{
    winch_memory run;
    const winch_parameters parameters = {0.1, 0.25};
    const double start[1] = {0.3}, velocity[1] = {0.1};
    double u[2], q[1], p[1], t = 2.0;
    winch_linearized linearized;
    int k;

    require(winch_init(&run, &parameters, 0.125, t, start, velocity));
    for (k = 0; k < 50; k++) {
        u[0] = 0.25 * (k % 3);
        u[1] = -0.125 * (k % 4);
        require(winch_step_linearized(&run, u, t, NULL, &linearized));
        require(winch_state(&run, q, p));
        show("winch q", q, 1);
        show("winch by u", &linearized.by_input[0][0], 4);
        show("winch by c, a", &linearized.by_parameters[0][0], 4);
        t += 0.125;
    }
    require(winch_energy(&run, t, q));
    show("winch energy", q, 1);
}

static void swings(void)
{
    swing_memory run;
    const swing_parameters parameters = {0.1};
    const double start[1] = {0.3}, velocity[1] = {0.1};
    double q[1], p[1], t = 0.0;
    int k;

    require(swing_init(&run, &parameters, 0.125, t, start, velocity));
    for (k = 0; k < 50; k++) {
        require(swing_step(&run, t, NULL));
        require(swing_state(&run, q, p));
        show("swing q", q, 1);
        t += 0.125;
    }
}

int main(void)
{
    cart_poles();
    rings();
    winches();
    swings();
    return EXIT_SUCCESS;
}
