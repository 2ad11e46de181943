/* A pole held upright on a cart.
 *
 * The gain comes from A and B of the model's step, by Riccati's equation. A force takes effect one period after it was
 * computed: meanwhile the model says where the cart will be. The plant is the same system with other parameters and steps
 * ten times finer. */

#include <stdio.h>
#include <stdlib.h>

#include "cart_pole.h"

#define PERIOD 0.01  /* s */
#define PERIODS 1000
#define LARGEST 30.0 /* N */
enum { STATES = 4 }; /* (q, p) */

static const cart_pole_parameters believed = {1.0, 0.30, 0.4, {0.30, 0.004}};
static const cart_pole_parameters real = {1.1, 0.27, 0.4, {0.45, 0.006}};

static void require(dalembert_status status)
{
    if (status != DALEMBERT_OK) {
        fprintf(stderr, "%s\n", cart_pole_text(status));
        exit(EXIT_FAILURE);
    }
}

/* K of u = -K (q, p), for the costs 10 x^2 + 50 angle^2 + p^2 + 0.1 u^2: the Riccati equation, iterated to its fixed point. */
static void regulator(const cart_pole_linearized *model, double gain[STATES])
{
    static const double weight[STATES] = {10.0, 50.0, 1.0, 1.0};
    double cost[STATES][STATES] = {{0.0}}, by_input[STATES], next[STATES][STATES], product[STATES][STATES];
    int i, j, k, round;

    for (round = 0; round < 5000; round++) {
        double square = 0.1;
        for (i = 0; i < STATES; i++) {
            by_input[i] = 0.0;
            for (k = 0; k < STATES; k++)
                by_input[i] += cost[i][k] * model->by_input[k][0];
            square += by_input[i] * model->by_input[i][0];
            for (j = 0; j < STATES; j++) {
                product[i][j] = 0.0;
                for (k = 0; k < STATES; k++)
                    product[i][j] += cost[i][k] * model->by_state[k][j];
            }
        }
        for (j = 0; j < STATES; j++) {
            gain[j] = 0.0;
            for (k = 0; k < STATES; k++)
                gain[j] += by_input[k] * model->by_state[k][j] / square;
        }
        for (i = 0; i < STATES; i++)
            for (j = 0; j < STATES; j++) {
                next[i][j] = (i == j ? weight[i] : 0.0) - square * gain[i] * gain[j];
                for (k = 0; k < STATES; k++)
                    next[i][j] += model->by_state[k][i] * product[k][j];
            }
        for (i = 0; i < STATES; i++)
            for (j = 0; j < STATES; j++)
                cost[i][j] = 0.5 * (next[i][j] + next[j][i]);
    }
}

int main(void)
{
    static cart_pole_memory model, plant;
    const double rest[2] = {0.0, 0.0}, tilted[2] = {0.0, 0.2};
    double gain[STATES], q[2], p[2], u[1] = {0.0};
    cart_pole_linearized upright;
    int k, part;

    require(cart_pole_init(&model, &believed, PERIOD, rest, rest));
    require(cart_pole_step_linearized(&model, u, NULL, &upright));
    regulator(&upright, gain);

    require(cart_pole_init(&plant, &real, PERIOD / 10.0, tilted, rest));
    printf("     t      x/m  angle/rad     u/N  iterations\n");
    for (k = 0; k < PERIODS; k++) {
        dalembert_report report = {0};
        dalembert_status status;
        double next;

        /* What the sensors say, and where the model goes from there with the force under way. */
        require(cart_pole_state(&plant, q, p));
        require(cart_pole_set_state(&model, q, p));
        status = cart_pole_step(&model, u, &report);
        if (status == DALEMBERT_OK)
            require(cart_pole_state(&model, q, p));
        else
            fprintf(stderr, "period %d: %s\n", k, cart_pole_text(status)); /* go on with what was measured */

        next = -(gain[0] * q[0] + gain[1] * q[1] + gain[2] * p[0] + gain[3] * p[1]);
        next = next > LARGEST ? LARGEST : next < -LARGEST ? -LARGEST : next;

        /* The plant's period, with the force computed in the last one. */
        for (part = 0; part < 10; part++)
            require(cart_pole_step(&plant, u, NULL));
        if (k % 100 == 0)
            printf("%6.2f %8.4f %10.5f %7.2f  %10u\n", k * PERIOD, q[0], q[1], u[0], (unsigned)report.iterations);
        u[0] = next;
    }
    require(cart_pole_state(&plant, q, p));
    printf("after %.0f s: %.1e m from the middle, %.1e rad from upright\n", PERIODS * PERIOD, q[0], q[1]);
    return q[1] * q[1] < 1e-6 ? EXIT_SUCCESS : EXIT_FAILURE;
}
