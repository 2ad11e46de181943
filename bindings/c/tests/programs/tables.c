/* Systems with tables: points in C, their bits, and what is refused. */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bead.h"
#include "ring.h"
#include "rocket.h"

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

static void a_rocket(void)
{
    static rocket_memory run;
    rocket_memory before;
    rocket_parameters parameters = {
        .mass = 2.0,
        .thrust = {.x = {0.0, 0.25, 2.0, 2.25}, .y = {0.0, 60.0, 45.0, 0.0}, .interpolation = DALEMBERT_LINEAR},
        .rail = {{0.0, 0.5, 1.0, 2.0, 3.0}, {2.0, 1.0, 0.5, 0.75, 1.0}, DALEMBERT_MONOTONE, 1},
    };
    const double q[1] = {0.0}, v[1] = {0.0};
    dalembert_wrong_point wrong;
    double at[2], t = 0.0;
    int k;

    REQUIRE(rocket_wrong_point(&parameters, &wrong));
    EXPECT(wrong.table == NULL && wrong.status == DALEMBERT_OK);
    REQUIRE(rocket_init(&run, &parameters, 0.125, t, q, v));
    for (k = 0; k < 40; k++) {
        REQUIRE(rocket_step(&run, t, NULL));
        REQUIRE(rocket_state(&run, &at[0], &at[1]));
        show("rocket q p", at, 2);
        t += 0.125;
    }

    /* Points that are no table: which, in which field, and the run is as it was. */
    memcpy(&before, &run, sizeof before);
    parameters.rail.x[3] = 1.0;
    EXPECT(rocket_set_parameters(&run, &parameters) == DALEMBERT_POINTS_NOT_INCREASING);
    REQUIRE(rocket_wrong_point(&parameters, &wrong));
    EXPECT(strcmp(wrong.table, "rail") == 0 && wrong.point == 3);
    EXPECT(wrong.status == DALEMBERT_POINTS_NOT_INCREASING);
    parameters.rail.x[3] = 2.0;
    parameters.thrust.interpolation = 0;
    EXPECT(rocket_set_parameters(&run, &parameters) == DALEMBERT_NO_INTERPOLATION);
    EXPECT(strstr(rocket_text(DALEMBERT_NO_INTERPOLATION), "DALEMBERT_LINEAR") != NULL);
    EXPECT(memcmp(&before, &run, sizeof before) == 0);
    parameters.thrust.interpolation = DALEMBERT_SPLINE;
    REQUIRE(rocket_set_parameters(&run, &parameters));
    EXPECT(memcmp(&before, &run, sizeof before) != 0);
}

/* docs/embedding.md shows it. */
static void of_the_page(void)
{
    rocket_parameters parameters = {
        .mass = 2.0,
        .thrust = {.x = {0.0, 0.25, 2.0, 2.25}, .y = {0.0, 60.0, 45.0, 0.0}, .interpolation = DALEMBERT_LINEAR},
        .rail = {
            .x = {0.0, 0.5, 1.0, 2.0, 3.0},
            .y = {2.0, 1.0, 0.5, 0.75, 1.0},
            .interpolation = DALEMBERT_MONOTONE,
            .straight_beyond = 1,
        },
    };
    dalembert_wrong_point wrong;
    if (rocket_wrong_point(&parameters, &wrong) == DALEMBERT_OK && wrong.table != NULL)
        printf("%s, point %u: %s\n", wrong.table, (unsigned)wrong.point, rocket_text((dalembert_status)wrong.status));
    EXPECT(wrong.table == NULL);
}

static void a_bead(void)
{
    bead_memory *run = malloc(sizeof *run);
    bead_parameters parameters = {
        .height = {{-1.0f, -0.5f, 0.25f, 0.5f, 1.0f, 2.0f}, {1.0f, 0.375f, 0.125f, 0.25f, 0.75f, 2.0f}, DALEMBERT_SPLINE, 0},
    };
    const float start[2] = {0.25f, 0.125f}, rest[2] = {0.0f, 0.0f};
    float q[2];
    double wide[2];
    int k;

    if (run == NULL)
        exit(EXIT_FAILURE);
    REQUIRE(bead_init(run, &parameters, 0.0625f, start, rest));
    for (k = 0; k < 20; k++) {
        REQUIRE(bead_step(run, NULL));
        REQUIRE(bead_state(run, q, NULL));
        wide[0] = (double)q[0];
        wide[1] = (double)q[1];
        show("bead q", wide, 2);
    }
    free(run);
}

int main(void)
{
    of_the_page();
    a_rocket();
    a_bead();
#ifdef WRONG
    EXPECT(DALEMBERT_LINEAR == 2);
#endif
    if (failures > 0)
        printf("%d failed\n", failures);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
