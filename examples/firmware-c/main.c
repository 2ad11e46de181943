/* A pole held upright on a cart, a hundred times a second.
 *
 * The gain comes from A and B of the model's step, by Riccati's equation. A force takes effect one period after it was
 * computed: meanwhile the model says where the cart will be. The plant, where sensors and motor would be, is the same system with
 * other parameters and steps ten times finer. */

#include "board.h"
#include "cart_pole.h"

#define PERIOD 0.01f  /* s */
#define PERIODS 1000
#define LARGEST 30.0f /* N */
enum { STATES = 4 };  /* (q, p) */

static const cart_pole_parameters believed = {1.0f, 0.30f, 0.4f, {0.30f, 0.004f}};
static const cart_pole_parameters real = {1.1f, 0.27f, 0.4f, {0.45f, 0.006f}};

static cart_pole_memory model, plant;

static void require(dalembert_status status)
{
    if (status != DALEMBERT_OK) {
        board_write(cart_pole_text(status));
        board_exit(1);
    }
}

/* `value`, in thousandths of its unit, and what stands behind it. */
static void write_thousandths(float value, const char *behind)
{
    char text[16];
    int32_t rest = (int32_t)(1000.0f * value);
    char *digit = text + sizeof text - 1;
    const int is_negative = rest < 0;

    rest = is_negative ? -rest : rest;
    *digit = '\0';
    do {
        *--digit = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    if (is_negative)
        *--digit = '-';
    while (digit > text + 7)
        *--digit = ' ';
    board_write(digit);
    board_write(behind);
}

/* K of u = -K (q, p), for the costs 10 x^2 + 50 angle^2 + p^2 + 0.1 u^2: the Riccati equation, iterated to its fixed point. */
static void regulator(const cart_pole_linearized *model, float gain[STATES])
{
    static const float weight[STATES] = {10.0f, 50.0f, 1.0f, 1.0f};
    static float cost[STATES][STATES], next[STATES][STATES], product[STATES][STATES];
    float by_input[STATES];
    int i, j, k, round;

    for (round = 0; round < 2000; round++) {
        float square = 0.1f;
        for (i = 0; i < STATES; i++) {
            by_input[i] = 0.0f;
            for (k = 0; k < STATES; k++)
                by_input[i] += cost[i][k] * model->by_input[k][0];
            square += by_input[i] * model->by_input[i][0];
            for (j = 0; j < STATES; j++) {
                product[i][j] = 0.0f;
                for (k = 0; k < STATES; k++)
                    product[i][j] += cost[i][k] * model->by_state[k][j];
            }
        }
        for (j = 0; j < STATES; j++) {
            gain[j] = 0.0f;
            for (k = 0; k < STATES; k++)
                gain[j] += by_input[k] * model->by_state[k][j] / square;
        }
        for (i = 0; i < STATES; i++)
            for (j = 0; j < STATES; j++) {
                next[i][j] = (i == j ? weight[i] : 0.0f) - square * gain[i] * gain[j];
                for (k = 0; k < STATES; k++)
                    next[i][j] += model->by_state[k][i] * product[k][j];
            }
        for (i = 0; i < STATES; i++)
            for (j = 0; j < STATES; j++)
                cost[i][j] = 0.5f * (next[i][j] + next[j][i]);
    }
}

int main(void)
{
    const float rest[2] = {0.0f, 0.0f}, tilted[2] = {0.0f, 0.2f};
    float gain[STATES], q[2], p[2], u[1] = {0.0f};
    cart_pole_linearized upright;
    int k, part;

    require(cart_pole_init(&model, &believed, PERIOD, rest, rest));
    require(cart_pole_step_linearized(&model, u, NULL, &upright));
    regulator(&upright, gain);

    require(cart_pole_init(&plant, &real, PERIOD / 10.0f, tilted, rest));
    board_begin((uint32_t)(1e6f * PERIOD));
    for (k = 0; k < PERIODS; k++) {
        dalembert_status status;
        float next;

        /* What the sensors say, and where the model goes from there with the force under way. */
        board_wait();
        require(cart_pole_state(&plant, q, p));
        require(cart_pole_set_state(&model, q, p));
        status = cart_pole_step(&model, u, NULL);
        if (status == DALEMBERT_OK)
            require(cart_pole_state(&model, q, p));
        else
            board_write(cart_pole_text(status)); /* go on with what was measured */

        next = -(gain[0] * q[0] + gain[1] * q[1] + gain[2] * p[0] + gain[3] * p[1]);
        next = next > LARGEST ? LARGEST : next < -LARGEST ? -LARGEST : next;

        /* The plant's period, with the force computed in the last one. */
        for (part = 0; part < 10; part++)
            require(cart_pole_step(&plant, u, NULL));
        if (k % 100 == 0) {
            write_thousandths(q[0], " mm");
            write_thousandths(q[1], " mrad");
            write_thousandths(u[0], " mN\n");
        }
        u[0] = next;
    }
    require(cart_pole_state(&plant, q, p));
    write_thousandths(1000.0f * q[0], " um from the middle,");
    write_thousandths(1000.0f * q[1], " urad from upright\n");
    return q[1] * q[1] < 1e-6f ? 0 : 1;
}
