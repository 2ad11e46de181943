/* Steps the same systems by dalembert's functions and by CasADi's, in turns, and prints docs/evidence/casadi.md's tables. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "arm_gauss.h"
#include "arm_gauss_casadi.h"
#include "arm_midpoint.h"
#include "arm_midpoint_casadi.h"
#include "pendulum_gauss.h"
#include "pendulum_gauss_casadi.h"
#include "pendulum_midpoint.h"
#include "pendulum_midpoint_casadi.h"

enum { STEPS = 2000, ROUNDS = 101, MOST = 4 };
static const double H = 0.01;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *of)
{
    qsort(of, ROUNDS, sizeof *of, ascending);
    return of[ROUNDS / 2];
}

static void require(int holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "%s\n", what);
        exit(1);
    }
}

/* The torques of period i: what a controller might ask for. */
static void torques(double *u, int n, int i)
{
    for (int k = 0; k < n; k++) u[k] = 0.3 * sin(0.02 * i + 0.9 * k);
}

static double apart(const double *a, const double *b, int n)
{
    double most = 0;
    for (int k = 0; k < n; k++) most = fmax(most, fabs(a[k] - b[k]));
    return most;
}

typedef int casadi_function(const double **, double **, long long *, double *, int);

/* One run of CasADi's function. The guess goes on from the velocities of the two steps before. */
static void casadi_run(casadi_function *function, int n, int stages, const double *q0, const double *p0, const double *v0,
    double *end, double *a, double *b)
{
    static double w[4096];
    static long long iw[256];
    double q[MOST], p[MOST], u[MOST], guess[3 * MOST], root[3 * MOST], before[3 * MOST];
    memcpy(q, q0, n * sizeof *q);
    memcpy(p, p0, n * sizeof *p);
    for (int k = 0; k < n * stages; k++) guess[k] = before[k] = v0[k % n];
    for (int i = 0; i < STEPS; i++) {
        torques(u, n, i);
        const double *arg[64] = {q, p, u, guess};
        double *res[64] = {end, root, a, b};
        require(function(arg, res, iw, w, 0) == 0, "CasADi's step failed");
        memcpy(q, end, n * sizeof *q);
        memcpy(p, end + n, n * sizeof *p);
        for (int k = 0; k < n * stages; k++) guess[k] = 2 * root[k] - before[k];
        memcpy(before, root, n * stages * sizeof *root);
    }
}

#define CASE(PREFIX, N, STAGES, TITLE, ...)                                                                                       \
    static const PREFIX##_parameters PREFIX##_model = __VA_ARGS__;                                                                \
    static void PREFIX##_run(const double *q, const double *v, double *end, PREFIX##_linearized *linearized)                      \
    {                                                                                                                             \
        static PREFIX##_memory memory;                                                                                            \
        double u[N];                                                                                                              \
        require(PREFIX##_init(&memory, &PREFIX##_model, H, q, v) == DALEMBERT_OK, "init failed");                                 \
        for (int i = 0; i < STEPS; i++) {                                                                                         \
            torques(u, N, i);                                                                                                     \
            require((linearized ? PREFIX##_step_linearized(&memory, u, NULL, linearized) : PREFIX##_step(&memory, u, NULL)) ==    \
                    DALEMBERT_OK,                                                                                                 \
                "dalembert's step failed");                                                                                       \
        }                                                                                                                         \
        require(PREFIX##_state(&memory, end, end + N) == DALEMBERT_OK, "no state");                                               \
    }                                                                                                                             \
    static void PREFIX##_compare(const double *q, const double *v)                                                                \
    {                                                                                                                             \
        static PREFIX##_memory memory;                                                                                            \
        static PREFIX##_linearized linearized;                                                                                    \
        double p[N], ours[2 * N], theirs[2 * N], a[4 * N * N], b[2 * N * N], seconds[6][ROUNDS];                                  \
        require(PREFIX##_init(&memory, &PREFIX##_model, H, q, v) == DALEMBERT_OK, "init failed");                                 \
        require(PREFIX##_state(&memory, NULL, p) == DALEMBERT_OK, "no momentum");                                                 \
        for (int round = 0; round < ROUNDS; round++) {                                                                            \
            double began = now();                                                                                                 \
            PREFIX##_run(q, v, ours, NULL);                                                                                       \
            seconds[0][round] = now() - began, began = now();                                                                     \
            casadi_run(PREFIX##_casadi_step, N, STAGES, q, p, v, theirs, NULL, NULL);                                             \
            seconds[1][round] = now() - began, began = now();                                                                     \
            require(apart(ours, theirs, 2 * N) < 1e-8, "the steps differ");                                                       \
            PREFIX##_run(q, v, ours, &linearized);                                                                                \
            seconds[2][round] = now() - began, began = now();                                                                     \
            casadi_run(PREFIX##_casadi_linearized, N, STAGES, q, p, v, theirs, a, b);                                             \
            seconds[3][round] = now() - began, began = now();                                                                     \
            casadi_run(PREFIX##_casadi_implicit, N, STAGES, q, p, v, theirs, a, b);                                               \
            seconds[4][round] = now() - began, began = now();                                                                     \
            for (int row = 0; row < 2 * N; row++) {                                                                               \
                for (int column = 0; column < 2 * N; column++)                                                                    \
                    require(fabs(linearized.by_state[row][column] - a[row + 2 * N * column]) < 1e-6, "A differs");                \
                for (int column = 0; column < N; column++)                                                                        \
                    require(fabs(linearized.by_input[row][column] - b[row + 2 * N * column]) < 1e-6, "B differs");                \
            }                                                                                                                     \
        }                                                                                                                         \
        const double per_step = 1e9 / STEPS;                                                                                      \
        double ns[5];                                                                                                             \
        for (int k = 0; k < 5; k++) ns[k] = median(seconds[k]) * per_step;                                                        \
        const double fastest = ns[3] < ns[4] ? ns[3] : ns[4];                                                                     \
        printf("| %s | %.0f | %.0f | %.1f | %.0f | %.0f | %.0f | %.1f | %.0e |\n", TITLE, ns[0], ns[1], ns[1] / ns[0], ns[2], ns[3], \
            ns[4], fastest / ns[2], apart(ours, theirs, 2 * N));                                                                  \
    }                                                                                                                             \
    static void PREFIX##_memories(void)                                                                                           \
    {                                                                                                                             \
        printf("| %s | %zu | %zu | %zu |\n", TITLE, sizeof(PREFIX##_memory),                                                      \
            sizeof(double) * (PREFIX##_casadi_step_SZ_W) + sizeof(void *) * (PREFIX##_casadi_step_SZ_ARG + PREFIX##_casadi_step_SZ_RES) + \
                sizeof(long long) * PREFIX##_casadi_step_SZ_IW,                                                                   \
            sizeof(double) * (PREFIX##_casadi_linearized_SZ_W) +                                                                  \
                sizeof(void *) * (PREFIX##_casadi_linearized_SZ_ARG + PREFIX##_casadi_linearized_SZ_RES) +                        \
                sizeof(long long) * PREFIX##_casadi_linearized_SZ_IW);                                                            \
    }

CASE(pendulum_midpoint, 2, 1, "double pendulum, midpoint", {{1.0, 0.7}, {1.0, 0.8}, 9.81, {0.05, 0.03}})
CASE(pendulum_gauss, 2, 3, "double pendulum, Gauss 3", {{1.0, 0.7}, {1.0, 0.8}, 9.81, {0.05, 0.03}})
CASE(arm_midpoint, 3, 1, "arm, midpoint", {0.4, {2.0, 1.5}, {0.5, 0.4}, 0.8, 9.81, {0.5, 0.4, 0.3}})
CASE(arm_gauss, 3, 3, "arm, Gauss 3", {0.4, {2.0, 1.5}, {0.5, 0.4}, 0.8, 9.81, {0.5, 0.4, 0.3}})

/* What each makes of a number that is none. */
static void not_a_number(void)
{
    static pendulum_midpoint_memory memory;
    static double w[4096];
    static long long iw[256];
    const double q[2] = {1.0, 0.5}, rest[2] = {0, 0}, u[2] = {NAN, 0};
    double end[4] = {7, 7, 7, 7}, root[2];
    require(pendulum_midpoint_init(&memory, &pendulum_midpoint_model, H, q, rest) == DALEMBERT_OK, "init failed");
    pendulum_midpoint_memory before = memory;
    const dalembert_status status = pendulum_midpoint_step(&memory, u, NULL);
    printf("| an input that is NaN | `%s`; the memory as it was: %s |", "DALEMBERT_INPUT_NOT_FINITE",
        status == DALEMBERT_INPUT_NOT_FINITE && memcmp(&before, &memory, sizeof memory) == 0 ? "yes" : "NO");
    const double *arg[64] = {q, rest, u, rest};
    double *res[64] = {end, root};
    const int code = pendulum_midpoint_casadi_step(arg, res, iw, w, 0);
    printf(" returns %d; q1 = %g, %g |\n", code, end[0], end[1]);
}

int main(void)
{
    const double hung[2] = {1.0, 0.5}, still[3] = {0, 0, 0}, posed[3] = {0.2, 0.6, -0.9};
    printf("| | step, ns | CasADi | ratio | step with A and B, ns | CasADi, its derivatives | CasADi, written out | ratio to the better | ends apart |\n");
    printf("|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    pendulum_midpoint_compare(hung, still);
    pendulum_gauss_compare(hung, still);
    arm_midpoint_compare(posed, still);
    arm_gauss_compare(posed, still);
    printf("\nMemory that the caller hands over:\n\n| | dalembert, bytes | CasADi, step | CasADi, with A and B |\n|---|--:|--:|--:|\n");
    pendulum_midpoint_memories();
    pendulum_gauss_memories();
    arm_midpoint_memories();
    arm_gauss_memories();
    printf("\n| | dalembert | CasADi |\n|---|---|---|\n");
    not_a_number();
    return 0;
}
