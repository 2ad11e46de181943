/* The steps of one type of number, NUMBER; main.c includes this once for each. */

static void OF(_steps)(void)
{
    static const OF(_parameters) scene = {(NUMBER)1.0, (NUMBER)0.2, (NUMBER)0.4, (NUMBER)9.81, {(NUMBER)0.3, (NUMBER)0.01}};
    static const NUMBER at[2] = {(NUMBER)0.0, (NUMBER)0.1}, moving[2] = {(NUMBER)0.2, (NUMBER)0.0};
    static OF(_memory) memory;
    NUMBER q[2], p[2], u[1];
    uint32_t index, sum = 0, worst = 0, with_report = 0, iterations = 0;
    uint64_t hash = 0;

    require(OF(_init)(&memory, &scene, (NUMBER)0.01, at, moving) == DALEMBERT_OK);
    for (index = 0; index < STEPS; index++) {
        OF(_memory) copy = memory;
        dalembert_report report;
        dalembert_status status;
        uint32_t from, count;

        u[0] = (NUMBER)0.25 * (NUMBER)(index % 5) - (NUMBER)0.5;
        from = now();
        status = OF(_step)(&memory, u, NULL);
        count = instructions(from);
        require(status == DALEMBERT_OK);
        sum += count;
        worst = index > 0 && count > worst ? count : worst;

        /* The same step of a copy, which also says how it went. */
        from = now();
        status = OF(_step)(&copy, u, &report);
        with_report += instructions(from);
        require(status == DALEMBERT_OK);
        iterations += report.iterations;

        require(OF(_state)(&memory, q, p) == DALEMBERT_OK);
        hash = digest(digest(digest(digest(hash, (double)q[0]), (double)q[1]), (double)p[0]), (double)p[1]);
    }
    board_write("c pushed_" NAME " ");
    write_bits(hash);
    write_number(sum / STEPS);
    write_number(worst);
    write_number(iterations);
    write_number(with_report / STEPS);
    board_write("\n");

    /* Steps from far away, taken or not, take the most stack. */
    for (index = 0; index < 4; index++) {
        const NUMBER far = index == 0 ? (NUMBER)1e3 : index == 1 ? (NUMBER)1e10 : index == 2 ? (NUMBER)1e20 : (NUMBER)1e30;
        const NUMBER away[2] = {far, far};
        require(OF(_set_state)(&memory, away, away) == DALEMBERT_OK);
        require(OF(_set_step_size)(&memory, far) == DALEMBERT_OK);
        (void)OF(_step)(&memory, u, NULL);
    }
}
