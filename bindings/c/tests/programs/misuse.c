/* Every wrong use that can be seen, from C: refused, and not a byte changed. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cart_pole.h"
#include "ring.h"

static int failures = 0;

static void expect(dalembert_status found, dalembert_status expected, int line)
{
    if (found != expected) {
        printf("line %d: \"%s\", expected \"%s\"\n", line, cart_pole_text(found), cart_pole_text(expected));
        failures++;
    }
}

#define REFUSED(call, expected)                                    \
    do {                                                           \
        memcpy(&before, memory, sizeof before);                    \
        expect(call, expected, __LINE__);                          \
        if (memcmp(&before, memory, sizeof before) != 0) {         \
            printf("line %d: the memory was changed\n", __LINE__); \
            failures++;                                            \
        }                                                          \
    } while (0)

static const cart_pole_parameters parameters = {1.0, 0.3, 0.4, {0.3, 0.004}};

static void wrong_memory(cart_pole_memory *memory, dalembert_status expected)
{
    cart_pole_memory before;
    cart_pole_linearized linearized;
    double q[2] = {0.0, 0.0}, p[2] = {0.0, 0.0}, u[1] = {0.0}, number;

    REFUSED(cart_pole_step(memory, u, NULL), expected);
    REFUSED(cart_pole_step_linearized(memory, u, NULL, &linearized), expected);
    REFUSED(cart_pole_state(memory, q, p), expected);
    REFUSED(cart_pole_velocity(memory, q), expected);
    REFUSED(cart_pole_energy(memory, &number), expected);
    REFUSED(cart_pole_time(memory, &number), expected);
    REFUSED(cart_pole_state_after(memory, u, 0.1, q, p), expected);
    REFUSED(cart_pole_set_state(memory, q, p), expected);
    REFUSED(cart_pole_set_parameters(memory, &parameters), expected);
    REFUSED(cart_pole_set_step_size(memory, 0.1), expected);
}

int main(void)
{
    /* Bytes that nobody has initialised: whatever a heap has there. */
    cart_pole_memory *memory = malloc(sizeof *memory), before;
    unsigned char *odd = malloc(sizeof(cart_pole_memory) + 1);
    ring_memory *other = calloc(1, sizeof(cart_pole_memory) + sizeof(ring_memory));
    const ring_parameters ring = {1, 0.01f, {{1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.1f}}, {0, 0, 0}};
    const float start[2] = {0.0f, 1.2f}, velocity[2] = {0.5f, 0.0f};
    const double q[2] = {0.0, 0.2}, nan[2] = {0.0, NAN};
    double state[2], u[1] = {0.0}, *nothing = NULL;
    int k;

    if (memory == NULL || odd == NULL || other == NULL)
        return EXIT_FAILURE;
#ifndef UNINITIALISED
    memset(memory, 0xcc, sizeof *memory);
#endif
    memset(odd, 0, sizeof(cart_pole_memory) + 1);
    wrong_memory(memory, DALEMBERT_NOT_INITIALISED);
    wrong_memory((cart_pole_memory *)(void *)(odd + 1), DALEMBERT_MISALIGNED);
    expect(ring_init(other, &ring, 0.1f, start, velocity), DALEMBERT_OK, __LINE__);
    wrong_memory((cart_pole_memory *)(void *)other, DALEMBERT_NOT_INITIALISED);
    expect(cart_pole_step(NULL, u, NULL), DALEMBERT_NULL_POINTER, __LINE__);
    expect(cart_pole_init(NULL, &parameters, 0.01, q, q), DALEMBERT_NULL_POINTER, __LINE__);

    for (k = 0; k < 2; k++) {
        REFUSED(cart_pole_init_with(memory, sizeof *memory - 1, CART_POLE_LAYOUT, &parameters, 0.01, q, q), DALEMBERT_WRONG_MEMORY);
        REFUSED(cart_pole_init_with(memory, sizeof *memory, RING_LAYOUT, &parameters, 0.01, q, q), DALEMBERT_WRONG_MEMORY);
        REFUSED(cart_pole_init(memory, NULL, 0.01, q, q), DALEMBERT_NULL_POINTER);
        REFUSED(cart_pole_init(memory, &parameters, NAN, q, q), DALEMBERT_STEP_SIZE);
        REFUSED(cart_pole_init(memory, &parameters, 0.01, nan, q), DALEMBERT_NOT_FINITE);
        REFUSED(cart_pole_init(memory, &parameters, 0.01, q, nothing), DALEMBERT_NULL_POINTER);
        expect(cart_pole_init(memory, &parameters, 0.01, q, q), DALEMBERT_OK, __LINE__);
        expect(cart_pole_step(memory, u, NULL), DALEMBERT_OK, __LINE__);
    }
    REFUSED(cart_pole_step(memory, nothing, NULL), DALEMBERT_NULL_POINTER);
    REFUSED(cart_pole_step(memory, &nan[1], NULL), DALEMBERT_INPUT_NOT_FINITE);
    REFUSED(cart_pole_set_state(memory, q, nan), DALEMBERT_NOT_FINITE);
    REFUSED(cart_pole_step_linearized(memory, u, NULL, NULL), DALEMBERT_NULL_POINTER);
    /* The control: what is compared can differ, and the run goes on. */
    memcpy(&before, memory, sizeof before);
    expect(cart_pole_step(memory, u, NULL), DALEMBERT_OK, __LINE__);
    expect(cart_pole_state(memory, state, NULL), DALEMBERT_OK, __LINE__);
    if (memcmp(&before, memory, sizeof before) == 0)
        failures++;
    free(memory);
    free(odd);
    free(other);
    printf("%d wrong uses were not refused\n", failures);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
