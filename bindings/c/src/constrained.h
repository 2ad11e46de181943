/** The first constraint that a state violates, and by how much. */
typedef struct dalembert_violation {
    double amount;       /**< the value of the constraint, in its unit, or its rate, in that per unit of time; or NaN */
    int32_t status;      /**< DALEMBERT_OFF_CONSTRAINT: a value; DALEMBERT_LEAVES_CONSTRAINT: a rate; DALEMBERT_NO_DERIVATIVE_OF_CONSTRAINT; DALEMBERT_OK: none is violated */
    uint32_t constraint; /**< which one, from 0 */
} dalembert_violation;

DALEMBERT_ASSERT(sizeof(dalembert_violation) == 16, "dalembert_violation is laid out as in the library");

