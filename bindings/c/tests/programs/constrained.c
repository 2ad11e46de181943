/* Systems with constraints: their bits, their reactions beside closed forms, and what is refused. */

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cart_pole.h"
#include "rods.h"
#include "skate.h"
#include "spherical.h"

#define G 9.81

static int failures = 0;

static void expect(int holds, int line)
{
    if (!holds) {
        printf("line %d does not hold\n", line);
        failures++;
    }
}

#define EXPECT(holds) expect(holds, __LINE__)
#define REQUIRE(call) expect((call) == DALEMBERT_OK, __LINE__)
#define NEAR(found, expected, most) expect(fabs((found) - (expected)) <= (most), __LINE__)

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
    double wide[4];
    size_t i;
    for (i = 0; i < count; i++)
        wide[i] = (double)values[i];
    show(name, wide, count);
}

static void on_the_sphere(void)
{
    spherical_memory *run = malloc(sizeof *run), before;
    const spherical_parameters parameters = {1.3, 0.4}, free_of_drag = {1.3, 0.0};
    const double given[3] = {1.0, 0.1, 0.0}, fast[3] = {0.1, 1.0, 0.0}, rest[3] = {0.0, 0.0, 0.0};
    const double below[3] = {0.0, 0.0, -1.0}, side[3] = {1.0, 0.0, 0.0}, *nothing = NULL;
    double q[3], v[3], lambda[1], length;
    spherical_linearized linearized;
    dalembert_violation violation;
    int k;

    if (run == NULL)
        exit(EXIT_FAILURE);
    memset(run, 0xcc, sizeof *run);
    memcpy(&before, run, sizeof before);
    /* Off the sphere, and leaving it: which constraint, and by how much. */
    EXPECT(spherical_init(run, &parameters, 0.05, given, rest) == DALEMBERT_OFF_CONSTRAINT);
    REQUIRE(spherical_violation(&parameters, given, rest, &violation));
    EXPECT(violation.status == DALEMBERT_OFF_CONSTRAINT && violation.constraint == 0);
    NEAR(violation.amount, 0.005, 1e-15);
    EXPECT(spherical_init(run, &parameters, 0.05, side, fast) == DALEMBERT_LEAVES_CONSTRAINT);
    REQUIRE(spherical_violation(&parameters, side, fast, &violation));
    EXPECT(violation.status == DALEMBERT_LEAVES_CONSTRAINT && violation.amount == 0.1);
    EXPECT(strstr(spherical_text(DALEMBERT_OFF_CONSTRAINT), "nearest") != NULL);
    EXPECT(spherical_violation(NULL, given, rest, &violation) == DALEMBERT_NULL_POINTER);
    EXPECT(spherical_violation(&parameters, given, rest, NULL) == DALEMBERT_NULL_POINTER);
    EXPECT(memcmp(&before, run, sizeof before) == 0);
    EXPECT(spherical_reactions(run, lambda) == DALEMBERT_NOT_INITIALISED);

    /* The nearest is on the ray from the middle, its velocity along the sphere. */
    REQUIRE(spherical_nearest(&parameters, given, fast, q, v));
    length = sqrt(1.01);
    NEAR(q[0], 1.0 / length, 1e-15);
    NEAR(q[1], 0.1 / length, 1e-15);
    NEAR(q[0] * v[0] + q[1] * v[1], 0.0, 1e-15);
    REQUIRE(spherical_violation(&parameters, q, v, &violation));
    EXPECT(violation.status == DALEMBERT_OK);
    EXPECT(spherical_nearest(&parameters, rest, rest, q, v) == DALEMBERT_DEPENDENT_CONSTRAINTS);
    EXPECT(spherical_nearest(&parameters, given, nothing, q, v) == DALEMBERT_NULL_POINTER);
    NEAR(q[0], 1.0 / length, 1e-15);

    REQUIRE(spherical_init(run, &parameters, 0.05, q, v));
    EXPECT(spherical_reactions(run, lambda) == DALEMBERT_NO_STEP);
    EXPECT(spherical_reactions(run, NULL) == DALEMBERT_NULL_POINTER);
    for (k = 0; k < 50; k++) {
        REQUIRE(spherical_step(run, NULL));
        REQUIRE(spherical_state(run, q, v));
        REQUIRE(spherical_reactions(run, lambda));
        show("spherical q", q, 3);
        show("spherical lambda", lambda, 1);
        NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2], 1.0, 4e-15);
    }
    REQUIRE(spherical_step_linearized(run, NULL, &linearized));
    show("spherical A", &linearized.by_state[0][0], 36);
    REQUIRE(spherical_reactions(run, lambda));
    show("spherical lambda", lambda, 1);
    /* A state off the sphere is refused by the step, and the last step stays the one that is asked. */
    REQUIRE(spherical_set_state(run, given, rest));
    memcpy(&before, run, sizeof before);
    EXPECT(spherical_step(run, NULL) == DALEMBERT_OFF_CONSTRAINT);
    EXPECT(memcmp(&before, run, sizeof before) == 0);
    REQUIRE(spherical_reactions(run, &length));
    EXPECT(length == lambda[0]);
    REQUIRE(spherical_set_parameters(run, &free_of_drag));
    EXPECT(spherical_reactions(run, lambda) == DALEMBERT_NO_STEP);

    /* Hanging at rest: the force lambda q carries the weight. */
    REQUIRE(spherical_init(run, &parameters, 0.05, below, rest));
    REQUIRE(spherical_step(run, NULL));
    REQUIRE(spherical_reactions(run, lambda));
    NEAR(lambda[0], -1.3 * G, 1e-12);
    free(run);
}

static void rods_that_hang(void)
{
    rods_memory *run = malloc(sizeof *run);
    const rods_parameters parameters = {{1.0, 0.7}};
    const double start[4] = {0.6, -0.8, 0.6, -1.6}, below[4] = {0.0, -1.0, 0.0, -1.8}, rest[4] = {0.0, 0.0, 0.0, 0.0};
    double q[4], p[4], lambda[2], u[2] = {0.0, 2.0};
    rods_linearized linearized;
    int k;

    if (run == NULL)
        exit(EXIT_FAILURE);
    REQUIRE(rods_init(run, &parameters, 0.01, start, rest));
    for (k = 0; k < 50; k++) {
        u[0] = 0.25 * (k % 3);
        REQUIRE(rods_step(run, u, NULL));
        REQUIRE(rods_state(run, q, p));
        REQUIRE(rods_reactions(run, lambda));
        show("rods q", q, 4);
        show("rods lambda", lambda, 2);
    }
    REQUIRE(rods_step_linearized(run, u, NULL, &linearized));
    show("rods B", &linearized.by_input[0][0], 16);
    show("rods by m", &linearized.by_parameters[0][0], 16);

    /* At rest the rods carry what hangs on them, less what the input lifts. */
    for (k = 0; k < 2; k++) {
        u[0] = 0.0;
        u[1] = 2.0 * k;
        REQUIRE(rods_init(run, &parameters, 0.01, below, rest));
        REQUIRE(rods_step(run, u, NULL));
        REQUIRE(rods_reactions(run, lambda));
        NEAR(lambda[0], u[1] - 1.7 * G, 1e-11);
        NEAR(lambda[1], u[1] - 0.7 * G, 1e-11);
    }
    free(run);
}

static void a_skate_that_turns(void)
{
    skate_memory *run = malloc(sizeof *run);
    const skate_parameters parameters = {2.0f, 0.5f};
    const float start[3] = {0.0f, 0.0f, 0.25f}, askew[3] = {3.0f, 0.0f, 0.0f};
    float q[3], v[3], lambda[2], t = 0.5f;
    dalembert_violation violation;
    int k;

    if (run == NULL)
        exit(EXIT_FAILURE);
    /* The clock turns it, so that rest leaves the first constraint; the second is one of velocity. */
    EXPECT(skate_init(run, &parameters, 0.0625f, t, start, askew) == DALEMBERT_LEAVES_CONSTRAINT);
    REQUIRE(skate_violation(&parameters, t, start, askew, &violation));
    EXPECT(violation.status == DALEMBERT_LEAVES_CONSTRAINT && violation.constraint == 0);
    NEAR(violation.amount, -0.5, 1e-7);
    EXPECT(skate_init(run, &parameters, 0.0625f, 0.75f, start, askew) == DALEMBERT_OFF_CONSTRAINT);
    REQUIRE(skate_nearest(&parameters, t, start, askew, q, v));
    NEAR((double)v[2], 0.5, 1e-7);
    NEAR((double)v[1] * cos(0.25) - (double)v[0] * sin(0.25), 0.0, 1e-6);
    REQUIRE(skate_init(run, &parameters, 0.0625f, t, q, v));
    for (k = 0; k < 50; k++) {
        REQUIRE(skate_step(run, t, NULL));
        REQUIRE(skate_state(run, q, NULL));
        REQUIRE(skate_reactions(run, lambda));
        show_single("skate q", q, 3);
        show_single("skate lambda", lambda, 2);
        /* On a circle: nothing turns it, and the edge holds it by m v omega. */
        NEAR((double)lambda[0], 0.0, 1e-4);
        NEAR((double)lambda[1], 2.0 * 3.0 * cos(0.25) * 0.5, 2e-2);
        t += 0.0625f;
    }
    free(run);
}

int main(void)
{
    on_the_sphere();
    rods_that_hang();
    a_skate_that_turns();
#ifdef WRONG
    NEAR(G, 9.80, 1e-12);
#endif
    if (failures > 0)
        printf("%d failed\n", failures);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
