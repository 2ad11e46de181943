/* A program of which nothing is measured but its size: of nothing, of dalembert's step with A and B, of CasADi's. */
#ifdef OURS
#include "pendulum_midpoint.h"
int main(void)
{
    static pendulum_midpoint_memory memory;
    static pendulum_midpoint_linearized linearized;
    static const pendulum_midpoint_parameters model = {{1.0, 0.7}, {1.0, 0.8}, 9.81, {0.05, 0.03}};
    const double q[2] = {1.0, 0.5}, v[2] = {0, 0}, u[2] = {0, 0};
    return pendulum_midpoint_init(&memory, &model, 0.01, q, v) + pendulum_midpoint_step_linearized(&memory, u, 0, &linearized);
}
#elif defined THEIRS
#include "pendulum_midpoint_casadi.h"
int main(void)
{
    static double w[pendulum_midpoint_casadi_implicit_SZ_W], end[4], root[2], a[16], b[8];
    static long long iw[pendulum_midpoint_casadi_implicit_SZ_IW + 1];
    const double q[2] = {1.0, 0.5}, p[2] = {0, 0}, u[2] = {0, 0};
    const double *arg[pendulum_midpoint_casadi_implicit_SZ_ARG] = {q, p, u, p};
    double *res[pendulum_midpoint_casadi_implicit_SZ_RES] = {end, root, a, b};
    return pendulum_midpoint_casadi_implicit(arg, res, iw, w, 0);
}
#else
int main(void)
{
    return 0;
}
#endif
